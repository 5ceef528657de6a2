#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "kernels/pixel_row/load_as_float-inl.h"
#include "kernels/pixel_row/pixel_row.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

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

// Four pixels of three bytes at a time, from one load of 16 bytes. Returns the number of pixels
// loaded.
HWY_INLINE int load_byte_triples(const std::uint8_t* HWY_RESTRICT pixels, int width,
                                 float* HWY_RESTRICT row) {
  constexpr int kPixels = 4;
  constexpr int kReadPixels = 6;  // 16 bytes are part of so many
  constexpr std::uint8_t kNone = 0x80;
  const hn::FixedTag<std::uint8_t, 16> d8;
  const hn::CappedTag<float, 16> d;
  HWY_ALIGN constexpr std::uint8_t kPlaces[16] = {0, 1, 2, kNone, 3, 4,  5,  kNone,
                                                  6, 7, 8, kNone, 9, 10, 11, kNone};
  const auto places = hn::Load(d8, kPlaces);
  int x = 0;
  for (; x + kReadPixels <= width; x += kPixels) {
    HWY_ALIGN std::uint8_t bytes[16];
    hn::Store(hn::TableLookupBytesOr0(hn::LoadU(d8, pixels + 3 * x), places), d8, bytes);
    for (int i = 0; i < 4 * kPixels; i += static_cast<int>(hn::Lanes(d))) {
      hn::StoreU(load_as_float(d, bytes + i), d, row + 4 * x + i);
    }
  }
  return x;
}

// Loads read four values where three are needed, so the last pixel is read value by value.
template <int kChannels, typename T>
HWY_INLINE void load_colour(const T* HWY_RESTRICT pixels, int width, float* HWY_RESTRICT row) {
  const hn::FixedTag<float, 4> d;
  const auto wanted = hn::FirstN(d, kChannels);
  int x = 0;
  if constexpr (kChannels == 3 && std::is_same_v<T, std::uint8_t>) {
    x = load_byte_triples(pixels, width, row);
  }
  for (; x + 1 < width; ++x) {
    hn::StoreU(hn::IfThenElseZero(wanted, load_as_float(d, pixels + x * kChannels)), d,
               row + x * 4);
  }
  for (int c = 0; c < 4 && width > 0; ++c) {
    row[x * 4 + c] = c < kChannels ? static_cast<float>(pixels[x * kChannels + c]) : 0.0F;
  }
}

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
