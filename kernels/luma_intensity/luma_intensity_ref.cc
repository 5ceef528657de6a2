#include "kernels/luma_intensity/luma_intensity.h"

namespace vantage::kernels {

void luma_intensity_row_ref(const std::uint8_t* pixels, int width, int channels,
                            std::uint8_t* intensities) {
  for (int x = 0; x < width; ++x, pixels += channels) {
    intensities[x] = channels == 1
                         ? pixels[0]
                         : static_cast<std::uint8_t>(
                               (77 * pixels[0] + 150 * pixels[1] + 29 * pixels[2] + 128) / 256);
  }
}

void luma_row_ref(const std::uint8_t* pixels, int width, int channels, float* luma) {
  for (int x = 0; x < width; ++x, pixels += channels) {
    luma[x] = kLumaRed * static_cast<float>(pixels[0]) +
              kLumaGreen * static_cast<float>(pixels[1]) +
              kLumaBlue * static_cast<float>(pixels[2]);
  }
}

}  // namespace vantage::kernels
