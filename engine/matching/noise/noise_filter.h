#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/noise/noise_estimate.h"

namespace vantage {

/// Bilateral smoothing of 7×7 pixels (kernels/bilateral), which keeps edges.
struct NoiseFilter {
  double sigma_px = 0;             ///< of the weights by distance; 0: none
  double cut_off_grey_levels = 1;  ///< pixels that differ by more do not count
  /// Along rows, then along columns (Pham & van Vliet, ICME 2005): a third of the time, and as good
  /// on what codecs leave, but not on noise.
  bool is_separated = false;

  [[nodiscard]] bool smooths() const { return sigma_px > 0; }
};
/// The filter that pays for such noise (perf/log/2026-11-27-noise.md).
NoiseFilter filter_of(const FoundNoise& noise);

/// A photograph as costs see it: smoothed intensities of 16 bits. Working memory, reused without
/// allocation for images of the same size. What it makes must not outlive the photograph.
class SmoothedPhotograph {
 public:
  /// channels: 1, or 3 of a colour photograph. Identical for any `execution`.
  const Photograph& make(const Photograph& photograph, int channels, const NoiseFilter& filter,
                         Execution& execution);
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  Photograph result_;
};

/// Bytes of all images of a call.
constexpr std::size_t smoothed_bytes(std::size_t pixels, std::size_t channels, std::size_t images) {
  return sizeof(std::uint16_t) * pixels * images * channels;
}

}  // namespace vantage
