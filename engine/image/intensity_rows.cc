#include "engine/image/intensity_rows.h"

#include <cstdint>
#include <type_traits>

#include "kernels/luma_intensity/luma_intensity.h"

namespace vantage {
namespace {

template <typename T>
void intensities(const T* pixels, int channels, int width, float* grey) {
  constexpr float unit = kGreyLevelsPerUnit<T>;
  if (channels < 3) {
    for (int x = 0; x < width; ++x) {
      grey[x] = static_cast<float>(pixels[x * channels]) * unit;
    }
    return;
  }
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    kernels::luma_row(pixels, width, channels, grey);
  } else {
    for (int x = 0; x < width; ++x) {
      const T* pixel = pixels + x * channels;
      grey[x] = (kernels::kLumaRed * static_cast<float>(pixel[0]) +
                 kernels::kLumaGreen * static_cast<float>(pixel[1]) +
                 kernels::kLumaBlue * static_cast<float>(pixel[2])) *
                unit;
    }
  }
}

}  // namespace

void intensity_row(const Photograph& photograph, int y, float* grey) {
  std::visit(
      [&](const auto& image) { intensities(image.row(y), image.channels(), image.width(), grey); },
      photograph.pixels);
}

void channel_intensity_row(const Photograph& photograph, int channel, int y, float* intensities) {
  std::visit(
      [&]<typename T>(const Image<T>& image) {
        const T* pixel = image.row(y) + channel;
        for (int x = 0; x < image.width(); ++x) {
          intensities[x] = static_cast<float>(pixel[x * image.channels()]) * kGreyLevelsPerUnit<T>;
        }
      },
      photograph.pixels);
}

}  // namespace vantage
