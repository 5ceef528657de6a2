#include <algorithm>
#include <cmath>

#include "kernels/byte_intensity/byte_intensity.h"

namespace vantage::kernels {

void rounded_intensity_row_ref(const float* intensities, int width, std::uint8_t* rounded) {
  std::transform(intensities, intensities + width, rounded, [](float intensity) {
    return static_cast<std::uint8_t>(std::nearbyint(intensity));
  });
}

void halved_intensity_row_ref(const std::uint8_t* upper, const std::uint8_t* lower, int width,
                              std::uint8_t* halved) {
  for (int x = 0; x < (width + 1) / 2; ++x) {
    const int right = std::min(2 * x + 1, width - 1);
    halved[x] = static_cast<std::uint8_t>(
        (upper[2 * x] + upper[right] + lower[2 * x] + lower[right] + 2) / 4);
  }
}

}  // namespace vantage::kernels
