#include "kernels/simd-inl.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "kernels/colour_fetch/bicubic_colours-inl.h"
#include "kernels/pixel_row/pixel_row.h"
#include "kernels/view_blend/blend_weights-inl.h"
#include "kernels/view_blend/view_blend.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

constexpr int kCacheLine = 64;

// Values of one channel in the type of the pixels.
template <typename T>
HWY_INLINE hn::VFromD<hn::Rebind<T, Values>> to_pixels(Vec value, Vec left, Vec right) {
  const Values d;
  const auto largest = hn::Set(d, kLargestValue<T>);
  if constexpr (std::is_same_v<T, float>) {
    const auto lower = hn::Min(hn::Zero(d), hn::Min(left, right));
    return hn::Min(hn::Max(value, lower), hn::Max(largest, hn::Max(left, right)));
  } else {
    const auto limited = hn::Min(hn::Max(value, hn::Zero(d)), largest);
    return hn::DemoteTo(hn::Rebind<T, Values>(),
                        hn::ConvertTo(Columns(), hn::Add(limited, hn::Set(d, 0.5F))));
  }
}

// Positions n to n + kAtOnce, which are [x, x + kAtOnce) of the rows of `pair` and `view`, and not
// at the ends of the first. `pixels`: that of position n.
template <int kChannels, typename T>
HWY_INLINE int blend_positions(const FetchedPairRow& fetched, const BlendWeights& weights, int n,
                               const WarpedPairRow& pair, int x, const BlendedRow<T>& view,
                               T* HWY_RESTRICT pixels) {
  constexpr bool kInRange = std::is_integral_v<T>;
  const Values d;
  const hn::Rebind<T, Values> d_pixel;
  HWY_ALIGN float left_weights[kAtOnce];
  const int holes = weigh(d, pair, weights, x, view, left_weights);
  const auto left_d = hn::LoadU(d, pair.left_disparity_px + x);
  const auto right_d = hn::LoadU(d, pair.right_disparity_px + x);
  Vec left[kChannels];
  Vec right[kChannels];
  fetch_colours<kChannels, kInRange>(fetched.left, n, left_d, left);
  fetch_colours<kChannels, kInRange>(fetched.right, n, right_d, right);
  const auto left_weight = hn::Load(d, left_weights);
  const auto right_weight = hn::Sub(hn::Set(d, 1.0F), left_weight);
  const auto is_known = hn::Or(hn::Eq(left_d, left_d), hn::Eq(right_d, right_d));
  hn::VFromD<decltype(d_pixel)> value[kChannels];
  for (int c = 0; c < kChannels; ++c) {
    const auto transformed = [d](Vec colour, float scale, float offset) HWY_ATTR {
      return hn::Add(hn::Mul(hn::Set(d, scale), colour), hn::Set(d, offset));
    };
    // Mul and Add, never MulAdd: results must not depend on the instruction set.
    const auto left_part =
        hn::Mul(left_weight, transformed(left[c], weights.left_scale[c], weights.left_offset[c]));
    const auto right_part = hn::Mul(
        right_weight, transformed(right[c], weights.right_scale[c], weights.right_offset[c]));
    const auto blended = hn::IfThenElseZero(is_known, hn::Add(left_part, right_part));
    value[c] = to_pixels<T>(blended, left[c], right[c]);
  }
  if constexpr (kChannels == 1) {
    hn::StoreU(value[0], d_pixel, pixels);
  } else if constexpr (kChannels == 3) {
    hn::StoreInterleaved3(value[0], value[1], value[2], d_pixel, pixels);
  } else {
    hn::StoreInterleaved4(value[0], value[1], value[2], value[3], d_pixel, pixels);
  }
  return holes;
}

// The first or last positions of a row, `count` of them: with a copy of the end as its neighbour, a
// surface goes on there.
template <int kChannels, typename T>
HWY_INLINE int blend_end(const FetchedPairRow& fetched, const BlendWeights& weights, int n,
                         int count, const BlendedRow<T>& view) {
  constexpr int kFloats = kAtOnce + 2;
  float disparity_px[2][kFloats];
  float blended_px[kFloats];
  std::uint8_t masks[2][kFloats];
  HWY_ALIGN T pixels[kChannels * kAtOnce];
  const auto copy = [&](const BicubicFetchRow& row, float* to) HWY_ATTR {
    std::fill_n(to, kFloats, std::numeric_limits<float>::quiet_NaN());
    for (int i = -1; i <= count; ++i) {
      to[1 + i] = row.warped_disparity_px[std::clamp(n + i, 0, row.width - 1)];
    }
  };
  copy(fetched.left, disparity_px[0]);
  copy(fetched.right, disparity_px[1]);
  WarpedPairRow pair;
  pair.left_disparity_px = disparity_px[0];
  pair.right_disparity_px = disparity_px[1];
  pair.width = kFloats;
  pair.gradient_limit_px = fetched.left.gradient_limit_px;
  const BlendedRow<T> part{pixels, blended_px, masks[0],
                           view.sources != nullptr ? masks[1] : nullptr};
  blend_positions<kChannels>(fetched, weights, n, pair, 1, part, pixels);
  std::copy_n(pixels, count * kChannels, view.pixels + n * kChannels);
  std::copy_n(blended_px + 1, count, view.disparity_px + n);
  std::copy_n(masks[0] + 1, count, view.holes + n);
  if (view.sources != nullptr) {
    std::copy_n(masks[1] + 1, count, view.sources + n);
  }
  return static_cast<int>(std::count(masks[0] + 1, masks[0] + 1 + count, std::uint8_t{255}));
}

template <int kChannels, typename T>
HWY_INLINE int blend_fetched_any(const FetchedPairRow& given, const BlendWeights& given_weights,
                                 const BlendedRow<T>& given_view) {
  // Copies: stores to pixels cannot alias them.
  const FetchedPairRow fetched = given;
  const BlendWeights weights = given_weights;
  const BlendedRow<T> view = given_view;
  const int width = fetched.left.width;
  WarpedPairRow pair;
  pair.left_disparity_px = fetched.left.warped_disparity_px;
  pair.right_disparity_px = fetched.right.warped_disparity_px;
  pair.width = width;
  pair.gradient_limit_px = fetched.left.gradient_limit_px;
  int holes = 0;
  for (int n = 0; n < width; n += kAtOnce) {
    for (const FetchedPairRow::NextRow& next : fetched.next) {
      const auto* values = static_cast<const std::uint8_t*>(next.values);
      for (int i = 0; values != nullptr && i < kAtOnce * next.bytes_per_position; i += kCacheLine) {
        hwy::Prefetch(values + n * next.bytes_per_position + i);
      }
    }
    if (n > 0 && n + kAtOnce < width) {
      holes += blend_positions<kChannels>(fetched, weights, n, pair, n, view,
                                          view.pixels + n * kChannels);
    } else {
      holes += blend_end<kChannels>(fetched, weights, n, std::min(kAtOnce, width - n), view);
    }
  }
  return holes;
}

template <typename T>
HWY_INLINE int blend_fetched(const FetchedPairRow& fetched, const BlendWeights& weights,
                             const BlendedRow<T>& view) {
  if (fetched.left.channels == 1) {
    return blend_fetched_any<1>(fetched, weights, view);
  }
  return fetched.left.channels == 3 ? blend_fetched_any<3>(fetched, weights, view)
                                    : blend_fetched_any<4>(fetched, weights, view);
}

int blend_fetched_u8(const FetchedPairRow& fetched, const BlendWeights& weights,
                     const BlendedRow<std::uint8_t>& view) {
  return blend_fetched(fetched, weights, view);
}
int blend_fetched_u16(const FetchedPairRow& fetched, const BlendWeights& weights,
                      const BlendedRow<std::uint16_t>& view) {
  return blend_fetched(fetched, weights, view);
}
int blend_fetched_f32(const FetchedPairRow& fetched, const BlendWeights& weights,
                      const BlendedRow<float>& view) {
  return blend_fetched(fetched, weights, view);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(blend_fetched_u8);
HWY_EXPORT(blend_fetched_u16);
HWY_EXPORT(blend_fetched_f32);

int blend_fetched_row(const FetchedPairRow& fetched, const BlendWeights& weights,
                      const BlendedRow<std::uint8_t>& view) {
  return HWY_DYNAMIC_DISPATCH(blend_fetched_u8)(fetched, weights, view);
}
int blend_fetched_row(const FetchedPairRow& fetched, const BlendWeights& weights,
                      const BlendedRow<std::uint16_t>& view) {
  return HWY_DYNAMIC_DISPATCH(blend_fetched_u16)(fetched, weights, view);
}
int blend_fetched_row(const FetchedPairRow& fetched, const BlendWeights& weights,
                      const BlendedRow<float>& view) {
  return HWY_DYNAMIC_DISPATCH(blend_fetched_f32)(fetched, weights, view);
}

}  // namespace vantage::kernels
#endif
