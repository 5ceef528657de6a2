#include "kernels/simd-inl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "kernels/bicubic_taps-inl.h"
#include "kernels/keys_weights.h"
#include "kernels/pixel_row/pixel_row.h"
#include "kernels/surface_fetch/surface_fetch.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
using Quad = hn::FixedTag<float, 4>;

// Source tap of each of the four taps, indexed by a bit mask of the taps on the surface. Taps 1 and
// 2 are the inner ones; if neither is on it, choose_nearest() applies instead.
using Choice = std::array<std::uint8_t, 4>;

constexpr std::array<Choice, 16> make_choices() {
  std::array<Choice, 16> choices{};
  for (unsigned bits = 0; bits < 16; ++bits) {
    const auto is_on = [bits](int tap) { return (bits >> tap & 1U) != 0; };
    const std::uint8_t inner1 = is_on(1) ? 1 : 2;
    const std::uint8_t inner2 = is_on(2) ? 2 : 1;
    choices[bits] = {is_on(0) && is_on(1) ? std::uint8_t{0} : inner1, inner1, inner2,
                     is_on(3) && is_on(2) ? std::uint8_t{3} : inner2};
  }
  return choices;
}
constexpr std::array<Choice, 16> kChoices = make_choices();
constexpr unsigned kInnerTaps = 0b0110;

// Tap inside the image that is nearest to the position. The image has `size` pixels; tap 0 is at
// `first`.
HWY_INLINE int nearest_tap(int first, int size, float fraction) {
  return std::clamp(fraction < 0.5F ? 1 : 2, -first, size - 1 - first);
}

template <int kChannels, typename T>
HWY_INLINE void copy_pixel(const T* from, T* to) {
  for (int c = 0; c < kChannels; ++c) {
    to[c] = from[c];
  }
}

// Sums over the lines for pixel i of a block (new pixel n), some of whose taps are on another
// surface or outside the image. on_surface: a bit mask of the taps on the surface per row.
template <int kChannels, typename T>
HWY_NOINLINE void sum_down_chosen(const SurfaceFetchRow<T>& row, int n,
                                  const std::uint8_t (&on_surface)[4], int i, TapSums& sums) {
  const int first_column = row.column[n] - 1;
  const int first_line = row.line[n] - 1;
  unsigned rows_on_surface = 0;
  for (unsigned j = 0; j < 4; ++j) {
    rows_on_surface |= (on_surface[j] & kInnerTaps) != 0 ? 1U << j : 0U;
  }
  T taps[4 * kTapLanes] = {};
  if ((rows_on_surface & kInnerTaps) == 0) {
    const int column = first_column + nearest_tap(first_column, row.width, row.fraction_x[n]);
    const int line = first_line + nearest_tap(first_line, row.height, row.fraction_y[n]);
    const T* pixel = row.pixels + line * row.stride + column * kChannels;
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 4; ++k) {
        copy_pixel<kChannels>(pixel, taps + j * kTapLanes + k * kChannels);
      }
    }
  } else {
    const Choice& lines = kChoices[rows_on_surface];
    for (int j = 0; j < 4; ++j) {
      const Choice& columns = kChoices[on_surface[lines[j]]];
      const T* pixels = row.pixels + (first_line + lines[j]) * row.stride +
                        static_cast<std::ptrdiff_t>(first_column) * kChannels;
      for (int k = 0; k < 4; ++k) {
        copy_pixel<kChannels>(pixels + columns[k] * kChannels,
                              taps + j * kTapLanes + k * kChannels);
      }
    }
  }
  sum_down<kChannels>(taps, kTapLanes, i, sums);
}

// Same where taps may lie outside the image.
template <int kChannels, typename T>
HWY_NOINLINE void sum_down_at_border(const SurfaceFetchRow<T>& row, int n, int i, TapSums& sums) {
  std::uint8_t on_surface[4] = {};
  for (int j = 0; j < 4; ++j) {
    const int line = row.line[n] - 1 + j;
    for (int k = 0; k < 4; ++k) {
      const int column = row.column[n] - 1 + k;
      if (line >= 0 && line < row.height && column >= 0 && column < row.width &&
          std::abs(row.map_px[line * row.map_stride + column] - row.disparity_px[n]) <=
              row.gradient_limit_px) {
        on_surface[j] = static_cast<std::uint8_t>(on_surface[j] | 1U << k);
      }
    }
  }
  sum_down_chosen<kChannels>(row, n, on_surface, i, sums);
}

template <int kChannels, typename T>
HWY_INLINE void sum_down_inside(const SurfaceFetchRow<T>& row, int n, int i, TapSums& sums) {
  const Quad d;
  const int column = row.column[n] - 1;
  const int line = row.line[n] - 1;
  const float* map = row.map_px + line * row.map_stride + column;
  const auto wanted = hn::Set(d, row.disparity_px[n]);
  const auto limit = hn::Set(d, row.gradient_limit_px);
  const auto on_surface = [&](int j) HWY_ATTR {
    return hn::Le(hn::Abs(hn::Sub(hn::LoadU(d, map + j * row.map_stride), wanted)), limit);
  };
  const auto on0 = on_surface(0);
  const auto on1 = on_surface(1);
  const auto on2 = on_surface(2);
  const auto on3 = on_surface(3);
  if (HWY_LIKELY(hn::AllTrue(d, hn::And(hn::And(on0, on1), hn::And(on2, on3))))) {
    sum_down<kChannels>(
        row.pixels + line * row.stride + static_cast<std::ptrdiff_t>(column) * kChannels,
        row.stride, i, sums);
    return;
  }
  std::uint8_t bits[4][8];
  hn::StoreMaskBits(d, on0, bits[0]);
  hn::StoreMaskBits(d, on1, bits[1]);
  hn::StoreMaskBits(d, on2, bits[2]);
  hn::StoreMaskBits(d, on3, bits[3]);
  sum_down_chosen<kChannels>(row, n, {bits[0][0], bits[1][0], bits[2][0], bits[3][0]}, i, sums);
}

template <int kChannels, typename T>
HWY_INLINE void sum_down_nothing(int i, TapSums& sums) {
  constexpr int kTaps = kTapsLoaded<kChannels>;
  std::fill_n(sums.sum_down + kTaps * i, kTaps, 0.0F);
  if constexpr (std::is_same_v<T, float>) {
    std::fill_n(sums.min_down + kTaps * i, kTaps, 0.0F);
    std::fill_n(sums.max_down + kTaps * i, kTaps, 0.0F);
  }
}

template <class D, typename T>
HWY_INLINE void find_weights(D d, const SurfaceFetchRow<T>& row, int begin, int first, int count,
                             TapSums& sums) {
  for (int i = first; i < count; i += static_cast<int>(hn::Lanes(d))) {
    store_weights(d, hn::LoadU(d, row.fraction_x + begin + i),
                  hn::LoadU(d, row.fraction_y + begin + i), i, sums);
  }
}

template <int kChannels, typename T>
HWY_INLINE void fetch_channels(const SurfaceFetchRow<T>& given, float* HWY_RESTRICT colours) {
  const SurfaceFetchRow<T> row = given;  // a copy: stores to colours cannot alias it
  const hn::ScalableTag<float> d;
  const hn::CappedTag<float, 1> d_one;
  const Quad d_pixel;
  const int last_column = row.width - 3 - kPixelsReadBehind<kChannels>;
  const int last_line = row.height - 3;
  HWY_ALIGN TapSums sums;
  for (int begin = 0; begin < row.count; begin += kTapBlock) {
    const int count = std::min(kTapBlock, row.count - begin);
    const int whole_vectors = count - count % static_cast<int>(hn::Lanes(d));
    find_weights(d, row, begin, 0, whole_vectors, sums);
    find_weights(d_one, row, begin, whole_vectors, count, sums);
    for (int i = 0; i < count; ++i) {
      const int n = begin + i;
      const int column = row.column[n];
      const int line = row.line[n];
      if (HWY_UNLIKELY(std::isnan(row.disparity_px[n]))) {
        sum_down_nothing<kChannels, T>(i, sums);
      } else if (HWY_LIKELY(column >= 1 && column <= last_column && line >= 1 &&
                            line <= last_line)) {
        sum_down_inside<kChannels>(row, n, i, sums);
      } else {
        sum_down_at_border<kChannels>(row, n, i, sums);
      }
    }
    if constexpr (kChannels == 1) {
      for (int i = 0; i < whole_vectors; i += static_cast<int>(hn::Lanes(d))) {
        hn::StoreU(sum_along_grey<T>(d, sums, i), d, colours + begin + i);
      }
      for (int i = whole_vectors; i < count; ++i) {
        hn::StoreU(sum_along_grey<T>(d_one, sums, i), d_one, colours + begin + i);
      }
    } else {
      const auto channels = hn::FirstN(d_pixel, kChannels);
      for (int i = 0; i < count; ++i) {
        hn::StoreU(hn::IfThenElseZero(channels, sum_along_colour<kChannels, T>(sums, i)), d_pixel,
                   colours + 4 * (begin + i));
      }
    }
  }
}

template <typename T>
void fetch_any(const SurfaceFetchRow<T>& row, float* colours) {
  if (row.channels == 1) {
    fetch_channels<1>(row, colours);
  } else if (row.channels == 3) {
    fetch_channels<3>(row, colours);
  } else {
    fetch_channels<4>(row, colours);
  }
}

void fetch_u8(const SurfaceFetchRow<std::uint8_t>& row, float* colours) { fetch_any(row, colours); }
void fetch_u16(const SurfaceFetchRow<std::uint16_t>& row, float* colours) {
  fetch_any(row, colours);
}
void fetch_f32(const SurfaceFetchRow<float>& row, float* colours) { fetch_any(row, colours); }

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(fetch_u8);
HWY_EXPORT(fetch_u16);
HWY_EXPORT(fetch_f32);

void fetch_surface_row(const SurfaceFetchRow<std::uint8_t>& row, float* colours) {
  HWY_DYNAMIC_DISPATCH(fetch_u8)(row, colours);
}
void fetch_surface_row(const SurfaceFetchRow<std::uint16_t>& row, float* colours) {
  HWY_DYNAMIC_DISPATCH(fetch_u16)(row, colours);
}
void fetch_surface_row(const SurfaceFetchRow<float>& row, float* colours) {
  HWY_DYNAMIC_DISPATCH(fetch_f32)(row, colours);
}

}  // namespace vantage::kernels
#endif
