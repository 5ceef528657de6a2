#pragma once

#include <array>

namespace vantage::kernels {

/// One row of a reference image and one of the image it is compared with, as `kPlanes` feature
/// planes (grey levels, gradient components, …) per channel. Candidate i of column j compares
/// reference[j] with partner[j · partner_step + i] in all planes.
template <typename T, int kPlanes>
struct FeaturePairs {
  struct Channel {
    std::array<const T*, kPlanes> reference{};  ///< at the first column
    std::array<const T*, kPlanes> partner{};    ///< at candidate 0 of the first column
  };
  std::array<Channel, 3> channel;
  int channels = 1;  ///< 1 or 3
  int partner_step =
      1;  ///< +1; −1 if the partner row is mirrored; lanes if each column has its own partner row
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  /// Number of candidates. Kernels that say so write 0 to lanes ≥ count.
  int count = 0;
};

}  // namespace vantage::kernels
