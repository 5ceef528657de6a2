#pragma once

#include <array>

namespace vantage::kernels {

/// One row of a reference image and of an image it is compared with, as `kPlanes` feature planes
/// (grey levels, gradient components, …) of each channel. Candidate i of column j compares
/// reference[j] with partner[j · partner_step + i], in all planes.
template <typename T, int kPlanes>
struct FeaturePairs {
  struct Channel {
    std::array<const T*, kPlanes> reference{};  ///< of the first column
    std::array<const T*, kPlanes> partner{};    ///< of candidate 0 of the first column
  };
  std::array<Channel, 3> channel;
  int channels = 1;      ///< 1 or 3
  int partner_step = 1;  ///< +1; −1 for a mirrored partner; lanes for a row of its own per column
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  /// Candidates: kernels that say so write 0 to the lanes from here on.
  int count = 0;
};

}  // namespace vantage::kernels
