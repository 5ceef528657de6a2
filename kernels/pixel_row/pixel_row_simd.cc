#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernels/pixel_row/load_as_float-inl.h"
#include "kernels/pixel_row/pixel_row.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

template <class D, class V>
HWY_INLINE hn::VFromD<D> to_float(D d, V values) {
  if constexpr (std::is_same_v<hn::TFromV<V>, float>) {
    return values;
  } else {
    return hn::ConvertTo(d, hn::PromoteTo(hn::Rebind<std::int32_t, D>(), values));
  }
}

template <int kChannels, typename T>
HWY_INLINE void load_planes(const T* HWY_RESTRICT pixels, int width, std::ptrdiff_t stride,
                            float* HWY_RESTRICT planes) {
  for (int c = 0; c < kChannels; ++c) {
    float* plane = planes + c * stride;
    std::fill_n(plane - kRowMarginPx, kRowMarginPx, 0.0F);
    std::fill_n(plane + width, kRowMarginPx, 0.0F);
  }
  const hn::CappedTag<float, 16> d;
  const hn::Rebind<T, decltype(d)> d_pixel;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(d));
  int x = 0;
  for (; x + kLanes <= width; x += kLanes) {
    if constexpr (kChannels == 1) {
      hn::StoreU(load_as_float(d, pixels + x), d, planes + x);
    } else {
      hn::VFromD<decltype(d_pixel)> value[4];
      if constexpr (kChannels == 3) {
        hn::LoadInterleaved3(d_pixel, pixels + 3 * x, value[0], value[1], value[2]);
      } else {
        hn::LoadInterleaved4(d_pixel, pixels + 4 * x, value[0], value[1], value[2], value[3]);
      }
      for (int c = 0; c < kChannels; ++c) {
        hn::StoreU(to_float(d, value[c]), d, planes + c * stride + x);
      }
    }
  }
  for (; x < width; ++x) {
    for (int c = 0; c < kChannels; ++c) {
      planes[c * stride + x] = static_cast<float>(pixels[x * kChannels + c]);
    }
  }
}

template <typename T>
HWY_INLINE void load_any(const T* pixels, int width, int channels, std::ptrdiff_t stride,
                         float* planes) {
  if (channels == 1) {
    load_planes<1>(pixels, width, stride, planes);
  } else if (channels == 3) {
    load_planes<3>(pixels, width, stride, planes);
  } else {
    load_planes<4>(pixels, width, stride, planes);
  }
}

void load_u8(const std::uint8_t* pixels, int width, int channels, std::ptrdiff_t stride,
             float* planes) {
  load_any(pixels, width, channels, stride, planes);
}
void load_u16(const std::uint16_t* pixels, int width, int channels, std::ptrdiff_t stride,
              float* planes) {
  load_any(pixels, width, channels, stride, planes);
}
void load_f32(const float* pixels, int width, int channels, std::ptrdiff_t stride, float* planes) {
  load_any(pixels, width, channels, stride, planes);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(load_u8);
HWY_EXPORT(load_u16);
HWY_EXPORT(load_f32);

void load_pixel_planes(const std::uint8_t* pixels, int width, int channels, std::ptrdiff_t stride,
                       float* planes) {
  HWY_DYNAMIC_DISPATCH(load_u8)(pixels, width, channels, stride, planes);
}
void load_pixel_planes(const std::uint16_t* pixels, int width, int channels, std::ptrdiff_t stride,
                       float* planes) {
  HWY_DYNAMIC_DISPATCH(load_u16)(pixels, width, channels, stride, planes);
}
void load_pixel_planes(const float* pixels, int width, int channels, std::ptrdiff_t stride,
                       float* planes) {
  HWY_DYNAMIC_DISPATCH(load_f32)(pixels, width, channels, stride, planes);
}

}  // namespace vantage::kernels
#endif
