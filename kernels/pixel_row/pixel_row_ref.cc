#include <algorithm>

#include "kernels/pixel_row/pixel_row.h"

namespace vantage::kernels {
namespace {

template <int kChannels, typename T>
void load_pixels(const T* pixels, int width, float* row) {
  constexpr int kLanes = pixel_lanes(kChannels);
  std::fill_n(row - kRowMarginPx * kLanes, kRowMarginPx * kLanes, 0.0F);
  std::fill_n(row + width * kLanes, kRowMarginPx * kLanes, 0.0F);
  for (int x = 0; x < width; ++x) {
    for (int c = 0; c < kChannels; ++c) {
      row[x * kLanes + c] = static_cast<float>(pixels[x * kChannels + c]);
    }
    if constexpr (kChannels == 3) {
      row[x * kLanes + 3] = 0.0F;
    }
  }
}

template <typename T>
void load_pixels_of(const T* pixels, int width, int channels, float* row) {
  if (channels == 1) {
    load_pixels<1>(pixels, width, row);
  } else if (channels == 3) {
    load_pixels<3>(pixels, width, row);
  } else {
    load_pixels<4>(pixels, width, row);
  }
}

}  // namespace

void load_pixel_row_ref(const std::uint8_t* pixels, int width, int channels, float* row) {
  load_pixels_of(pixels, width, channels, row);
}
void load_pixel_row_ref(const std::uint16_t* pixels, int width, int channels, float* row) {
  load_pixels_of(pixels, width, channels, row);
}
void load_pixel_row_ref(const float* pixels, int width, int channels, float* row) {
  load_pixels_of(pixels, width, channels, row);
}

}  // namespace vantage::kernels
