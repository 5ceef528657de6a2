#pragma once

#include <array>
#include <cstddef>

#include "engine/execution.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Steps of anisotropic diffusion (kernels/intensity_diffusion), which smooth differences that are
/// small beside `contrast_grey_levels` and keep edges. n steps reach √(0.4 n) px.
struct NoiseFilter {
  int steps = 0;
  double contrast_grey_levels = 1;
};

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
  std::array<Image<float>, 2> steps_;
};

/// Bytes of all images of a call, and of their making.
constexpr std::size_t smoothed_bytes(std::size_t pixels, std::size_t channels, std::size_t images) {
  return sizeof(float) * pixels * images * (channels + 2);
}

}  // namespace vantage
