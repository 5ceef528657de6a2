#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pixel_row/pixel_row_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>

#include "kernels/pixel_row/load_as_float-inl.h"
#include "kernels/pixel_row/pixel_row.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <typename T>
HWY_INLINE void load_grey(const T* HWY_RESTRICT pixels, int width, float* HWY_RESTRICT row) {
  const hn::ScalableTag<float> d;
  int x = 0;
  for (; x + static_cast<int>(hn::Lanes(d)) <= width; x += static_cast<int>(hn::Lanes(d))) {
    hn::StoreU(load_as_float(d, pixels + x), d, row + x);
  }
  for (; x < width; ++x) {
    row[x] = static_cast<float>(pixels[x]);
  }
}

#if HWY_TARGET == HWY_SCALAR
// HWY_SCALAR has no four-lane vector to hold a pixel.
template <int kChannels, typename T>
HWY_INLINE void load_colour(const T* pixels, int width, float* row) {
  load_pixel_row_ref(pixels, width, kChannels, row);
}
#else
// Loads read four values where three are needed, so the last pixel is read value by value.
template <int kChannels, typename T>
HWY_INLINE void load_colour(const T* HWY_RESTRICT pixels, int width, float* HWY_RESTRICT row) {
  const hn::FixedTag<float, 4> d;
  const auto wanted = hn::FirstN(d, kChannels);
  for (int x = 0; x + 1 < width; ++x) {
    hn::StoreU(hn::IfThenElseZero(wanted, load_as_float(d, pixels + x * kChannels)), d,
               row + x * 4);
  }
  for (int c = 0; c < 4 && width > 0; ++c) {
    const int x = width - 1;
    row[x * 4 + c] = c < kChannels ? static_cast<float>(pixels[x * kChannels + c]) : 0.0F;
  }
}
#endif

template <typename T>
HWY_INLINE void load_any(const T* pixels, int width, int channels, float* row) {
  const int margin = kRowMarginPx * pixel_lanes(channels);
  std::fill_n(row - margin, margin, 0.0F);
  std::fill_n(row + width * pixel_lanes(channels), margin, 0.0F);
  if (channels == 1) {
    load_grey(pixels, width, row);
  } else if (channels == 3) {
    load_colour<3>(pixels, width, row);
  } else {
    load_colour<4>(pixels, width, row);
  }
}

void load_u8(const std::uint8_t* pixels, int width, int channels, float* row) {
  load_any(pixels, width, channels, row);
}
void load_u16(const std::uint16_t* pixels, int width, int channels, float* row) {
  load_any(pixels, width, channels, row);
}
void load_f32(const float* pixels, int width, int channels, float* row) {
  load_any(pixels, width, channels, row);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(load_u8);
HWY_EXPORT(load_u16);
HWY_EXPORT(load_f32);

void load_pixel_row(const std::uint8_t* pixels, int width, int channels, float* row) {
  HWY_DYNAMIC_DISPATCH(load_u8)(pixels, width, channels, row);
}
void load_pixel_row(const std::uint16_t* pixels, int width, int channels, float* row) {
  HWY_DYNAMIC_DISPATCH(load_u16)(pixels, width, channels, row);
}
void load_pixel_row(const float* pixels, int width, int channels, float* row) {
  HWY_DYNAMIC_DISPATCH(load_f32)(pixels, width, channels, row);
}

}  // namespace vantage::kernels
#endif
