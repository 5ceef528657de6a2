#include "kernels/simd-inl.h"

#include <cstring>
#include <type_traits>

#include "kernels/pixel_row/pixel_row.h"
#include "kernels/view_blend/blend_weights-inl.h"
#include "kernels/view_blend/view_blend.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
// `room`: whether four values may be written where three are needed, because later pixels follow.
template <int kChannels, typename T, class D>
HWY_INLINE void store_pixel(D d, bool room, hn::VFromD<D> value, hn::VFromD<D> left,
                            hn::VFromD<D> right, T* pixel) {
  const auto zero = hn::Zero(d);
  const auto largest = hn::Set(d, kLargestValue<T>);
  if constexpr (std::is_same_v<T, float>) {
    const auto lower = hn::Min(zero, hn::Min(left, right));
    const auto upper = hn::Max(largest, hn::Max(left, right));
    const auto clamped = hn::Min(hn::Max(value, lower), upper);
    if constexpr (kChannels == 1) {
      hn::StoreU(clamped, d, pixel);
    } else {
      float values[4];
      hn::StoreU(clamped, d, values);
      std::memcpy(pixel, values, kChannels * sizeof(T));
    }
  } else {
    const hn::Rebind<std::int32_t, D> d32;
    const hn::Rebind<T, D> d_pixel;
    const auto rounded =
        hn::ConvertTo(d32, hn::Add(hn::Min(hn::Max(value, zero), largest), hn::Set(d, 0.5F)));
    const auto narrow = hn::DemoteTo(d_pixel, rounded);
    if (kChannels != 3 || room) {
      hn::StoreU(narrow, d_pixel, pixel);
    } else {
      T values[4];
      hn::StoreU(narrow, d_pixel, values);
      std::memcpy(pixel, values, kChannels * sizeof(T));
    }
  }
}

// Grey values of positions [x, x + lanes).
template <typename T, class D>
HWY_INLINE void blend_grey(D d, const WarpedPairRow& pair, const BlendWeights& weights, int x,
                           const float* HWY_RESTRICT left_weights, T* pixels) {
  const auto left = hn::LoadU(d, pair.left_colours + x);
  const auto right = hn::LoadU(d, pair.right_colours + x);
  const auto left_weight = hn::LoadU(d, left_weights);
  const auto transformed = [d](hn::VFromD<D> value, float scale, float offset) HWY_ATTR {
    return hn::Add(hn::Mul(hn::Set(d, scale), value), hn::Set(d, offset));
  };
  // Mul and Add, never MulAdd: results must not depend on the instruction set.
  const auto left_part =
      hn::Mul(left_weight, transformed(left, weights.left_scale[0], weights.left_offset[0]));
  const auto right_part =
      hn::Mul(hn::Sub(hn::Set(d, 1.0F), left_weight),
              transformed(right, weights.right_scale[0], weights.right_offset[0]));
  store_pixel<1>(d, true, hn::Add(left_part, right_part), left, right, pixels + x);
}

// Bytes of several pixels, of kChannels each in place of four lanes.
template <int kChannels, class D>
HWY_INLINE hn::VFromD<D> without_unused_lanes(D d, hn::VFromD<D> bytes) {
  if constexpr (kChannels == 4) {
    return bytes;
  }
  HWY_ALIGN constexpr std::uint8_t kPlaces[16] = {0,  1,  2,  4,  5,  6,  8,  9,
                                                  10, 12, 13, 14, 14, 14, 14, 14};
  HWY_ALIGN constexpr std::uint8_t kPlacesOfTwo[8] = {0, 1, 2, 4, 5, 6, 6, 6};
  return hn::TableLookupBytes(bytes, hn::Load(d, hn::MaxLanes(d) == 16 ? kPlaces : kPlacesOfTwo));
}

// Colours of as many positions from x of `count` as whole vectors of several byte pixels hold;
// returns their number. Stores reach up to kRoomPx positions beyond, where later ones follow.
template <int kChannels>
HWY_INLINE int blend_byte_pixels(const WarpedPairRow& pair, const BlendWeights& weights, int x,
                                 int count, const float* HWY_RESTRICT left_weights,
                                 std::uint8_t* pixels) {
  const hn::CappedTag<float, 16> d;
  const hn::Rebind<std::int32_t, decltype(d)> d32;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  constexpr int kAtOnce = static_cast<int>(hn::MaxLanes(d)) / 4;
  constexpr int kRoomPx = kChannels == 3 ? 2 : 0;
  if constexpr (kAtOnce == 1) {
    return 0;
  }
  const auto pixel_of_lane = hn::ShiftRight<2>(hn::Iota(d32, 0));
  const auto left_scale = hn::LoadDup128(d, weights.left_scale);
  const auto left_offset = hn::LoadDup128(d, weights.left_offset);
  const auto right_scale = hn::LoadDup128(d, weights.right_scale);
  const auto right_offset = hn::LoadDup128(d, weights.right_offset);
  const auto one = hn::Set(d, 1.0F);
  // Loaded as it was stored: a load of a part of it, or of more, would wait.
  const auto weights_of_all = hn::Load(d, left_weights);
  int i = 0;
  for (; i + kAtOnce <= count && x + i + kAtOnce + kRoomPx <= pair.width; i += kAtOnce) {
    const auto left = hn::LoadU(d, pair.left_colours + (x + i) * 4);
    const auto right = hn::LoadU(d, pair.right_colours + (x + i) * 4);
    const auto weight = hn::TableLookupLanes(
        weights_of_all, hn::IndicesFromVec(d, hn::Add(pixel_of_lane, hn::Set(d32, i))));
    // Mul and Add, never MulAdd: results must not depend on the instruction set.
    const auto left_part = hn::Mul(weight, hn::Add(hn::Mul(left_scale, left), left_offset));
    const auto right_part =
        hn::Mul(hn::Sub(one, weight), hn::Add(hn::Mul(right_scale, right), right_offset));
    const auto value = hn::Min(hn::Max(hn::Add(left_part, right_part), hn::Zero(d)),
                               hn::Set(d, kLargestValue<std::uint8_t>));
    const auto bytes = hn::DemoteTo(d8, hn::ConvertTo(d32, hn::Add(value, hn::Set(d, 0.5F))));
    hn::StoreU(without_unused_lanes<kChannels>(d8, bytes), d8, pixels + (x + i) * kChannels);
  }
  return i;
}

// Colours of positions [x, x + count); one vector is one pixel.
template <int kChannels, typename T>
HWY_INLINE void blend_pixels(const WarpedPairRow& pair, const BlendWeights& weights, int x,
                             int count, const float* HWY_RESTRICT left_weights, T* pixels) {
  constexpr int kLanes = pixel_lanes(kChannels);
  const hn::FixedTag<float, kLanes> d;
  const auto left_scale = hn::LoadU(d, weights.left_scale);
  const auto left_offset = hn::LoadU(d, weights.left_offset);
  const auto right_scale = hn::LoadU(d, weights.right_scale);
  const auto right_offset = hn::LoadU(d, weights.right_offset);
  const float* left_colours = pair.left_colours + x * kLanes;
  const float* right_colours = pair.right_colours + x * kLanes;
  int i = 0;
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    i = blend_byte_pixels<kChannels>(pair, weights, x, count, left_weights, pixels);
  }
  for (; i < count; ++i) {
    const auto left = hn::LoadU(d, left_colours + i * kLanes);
    const auto right = hn::LoadU(d, right_colours + i * kLanes);
    // Mul and Add, never MulAdd: results must not depend on the instruction set.
    const auto left_part =
        hn::Mul(hn::Set(d, left_weights[i]), hn::Add(hn::Mul(left_scale, left), left_offset));
    const auto right_part = hn::Mul(hn::Set(d, 1.0F - left_weights[i]),
                                    hn::Add(hn::Mul(right_scale, right), right_offset));
    store_pixel<kChannels>(d, x + i + 1 < pair.width, hn::Add(left_part, right_part), left, right,
                           pixels + (x + i) * kChannels);
  }
}

template <int kChannels, typename T>
HWY_INLINE int blend_any(const WarpedPairRow& pair, const BlendWeights& weights,
                         const BlendedRow<T>& view) {
  const hn::ScalableTag<float> d;
  const hn::FixedTag<float, 1> d_one;
  const int step = static_cast<int>(hn::Lanes(d));
  HWY_ALIGN float left_weights[hn::MaxLanes(hn::ScalableTag<float>())] = {};
  int holes = 0;
  const auto block = [&](auto tag, int x) HWY_ATTR {
    const int count = static_cast<int>(hn::Lanes(tag));
    const int block_holes = weigh(tag, pair, weights, x, view, left_weights);
    if constexpr (kChannels == 1) {
      blend_grey(tag, pair, weights, x, left_weights, view.pixels);
    } else {
      blend_pixels<kChannels>(pair, weights, x, count, left_weights, view.pixels);
    }
    if (block_holes > 0) {
      for (int i = x; i < x + count; ++i) {
        if (view.holes[i] != 0) {
          std::memset(view.pixels + i * kChannels, 0, kChannels * sizeof(T));
        }
      }
    }
    holes += block_holes;
  };
  // Positions at the row's ends have only one neighbour.
  const int margin = weights.trust_at_ends != 1.0F ? 1 : 0;
  int x = 0;
  for (; x < margin && x < pair.width; ++x) {
    block(d_one, x);
  }
  for (; x + step + margin <= pair.width; x += step) {
    block(d, x);
  }
  for (; x < pair.width; ++x) {
    block(d_one, x);
  }
  return holes;
}

template <typename T>
HWY_INLINE int blend_channels(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
                              const BlendedRow<T>& view) {
  if (channels == 1) {
    return blend_any<1>(pair, weights, view);
  }
  return channels == 3 ? blend_any<3>(pair, weights, view) : blend_any<4>(pair, weights, view);
}

int blend_u8(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
             const BlendedRow<std::uint8_t>& view) {
  return blend_channels(pair, weights, channels, view);
}
int blend_u16(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
              const BlendedRow<std::uint16_t>& view) {
  return blend_channels(pair, weights, channels, view);
}
int blend_f32(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
              const BlendedRow<float>& view) {
  return blend_channels(pair, weights, channels, view);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(blend_u8);
HWY_EXPORT(blend_u16);
HWY_EXPORT(blend_f32);

int blend_row(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
              const BlendedRow<std::uint8_t>& view) {
  return HWY_DYNAMIC_DISPATCH(blend_u8)(pair, weights, channels, view);
}
int blend_row(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
              const BlendedRow<std::uint16_t>& view) {
  return HWY_DYNAMIC_DISPATCH(blend_u16)(pair, weights, channels, view);
}
int blend_row(const WarpedPairRow& pair, const BlendWeights& weights, int channels,
              const BlendedRow<float>& view) {
  return HWY_DYNAMIC_DISPATCH(blend_f32)(pair, weights, channels, view);
}

}  // namespace vantage::kernels
#endif
