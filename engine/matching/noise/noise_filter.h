#pragma once

#include <array>
#include <cstddef>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/noise/noise_estimate.h"

namespace vantage {

/// Bilateral smoothing of 7×7 pixels (kernels/bilateral), which keeps edges.
struct NoiseFilter {
  double sigma_px = 0;             ///< of the weights by distance; 0: none
  double cut_off_grey_levels = 1;  ///< pixels that differ by more do not count

  [[nodiscard]] bool smooths() const { return sigma_px > 0; }
};
/// The filter that pays for such noise (perf/log/2026-11-27-noise.md).
NoiseFilter filter_of(const FoundNoise& noise);

/// A photograph as costs see it: smoothed intensities, floats 0..1. Working memory, reused without
/// allocation for images of the same size. What it makes must not outlive the photograph.
class SmoothedPhotograph {
 public:
  /// channels: 1, or 3 of a colour photograph. Identical for any `execution`.
  const Photograph& make(const Photograph& photograph, int channels, const NoiseFilter& filter,
                         Execution& execution);
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  Photograph result_;
  Image<float> padded_;  ///< of one channel, with its border repeated
};

/// Bytes of all images of a call, and of their making.
constexpr std::size_t smoothed_bytes(std::size_t pixels, std::size_t channels, std::size_t images) {
  return sizeof(float) * pixels * images * (channels + 1);
}

}  // namespace vantage
