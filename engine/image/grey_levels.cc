#include "engine/image/grey_levels.h"

namespace vantage {
namespace {

// Rec. 601.
constexpr float kRed = 0.299F;
constexpr float kGreen = 0.587F;
constexpr float kBlue = 0.114F;

template <typename T>
void grey_levels(const T* pixels, int channels, int width, float* grey) {
  constexpr float unit = kGreyLevelsPerUnit<T>;
  if (channels < 3) {
    for (int x = 0; x < width; ++x) {
      grey[x] = static_cast<float>(pixels[x * channels]) * unit;
    }
    return;
  }
  for (int x = 0; x < width; ++x) {
    const T* pixel = pixels + x * channels;
    grey[x] = (kRed * static_cast<float>(pixel[0]) + kGreen * static_cast<float>(pixel[1]) +
               kBlue * static_cast<float>(pixel[2])) *
              unit;
  }
}

}  // namespace

void grey_levels_row(const Photograph& photograph, int y, float* grey) {
  std::visit(
      [&](const auto& image) { grey_levels(image.row(y), image.channels(), image.width(), grey); },
      photograph.pixels);
}

void channel_levels_row(const Photograph& photograph, int channel, int y, float* levels) {
  std::visit(
      [&]<typename T>(const Image<T>& image) {
        const T* pixel = image.row(y) + channel;
        for (int x = 0; x < image.width(); ++x) {
          levels[x] = static_cast<float>(pixel[x * image.channels()]) * kGreyLevelsPerUnit<T>;
        }
      },
      photograph.pixels);
}

}  // namespace vantage
