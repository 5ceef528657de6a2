#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "kernels/bicubic_remap/bicubic_remap.h"
#include "kernels/bicubic_taps-inl.h"
#include "kernels/keys_weights.h"
#include "kernels/pixel_row/pixel_row.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
// Intermediate results between the steps. All of it stays in the level 1 cache.
struct Block {
  TapSums sums;
  std::int32_t column[kTapBlock];   // of the tap left of the position
  std::int32_t line[kTapBlock];     // of the tap above it
  std::int32_t is_seen[kTapBlock];  // non-zero: the position is inside the image
};

// Taps and weights of `count` pixels starting at `begin`. Returns whether all their taps lie inside
// the image with `spare` more columns to their right.
template <class D, typename T>
HWY_INLINE bool locate(D d, const RemapRow<T>& row, int begin, int first, int count, int spare,
                       Block& block) {
  const hn::RebindToSigned<D> di;
  const auto before = hn::Set(d, -0.5F);
  const auto behind_x = hn::Set(d, static_cast<float>(row.width) - 0.5F);
  const auto behind_y = hn::Set(d, static_cast<float>(row.height) - 0.5F);
  const auto one = hn::Set(d, 1.0F);
  const auto last_x = hn::Set(d, static_cast<float>(row.width - 3 - spare));
  const auto last_y = hn::Set(d, static_cast<float>(row.height - 3));
  auto all_within = hn::MaskFromVec(hn::BitCast(d, hn::Set(di, -1)));
  const int step = static_cast<int>(hn::Lanes(d));
  for (int i = first; i + step <= count; i += step) {
    const auto read_x = hn::LoadU(d, row.x_px + begin + i);
    const auto read_y = hn::LoadU(d, row.y_px + begin + i);
    const auto is_seen = hn::And(hn::And(hn::Ge(read_x, before), hn::Le(read_x, behind_x)),
                                 hn::And(hn::Ge(read_y, before), hn::Le(read_y, behind_y)));
    const auto x = hn::IfThenElseZero(is_seen, read_x);
    const auto y = hn::IfThenElseZero(is_seen, read_y);
    const auto whole_x = hn::Floor(x);
    const auto whole_y = hn::Floor(y);
    all_within =
        hn::And(all_within,
                hn::And(is_seen, hn::And(hn::And(hn::Ge(whole_x, one), hn::Le(whole_x, last_x)),
                                         hn::And(hn::Ge(whole_y, one), hn::Le(whole_y, last_y)))));
    hn::StoreU(hn::VecFromMask(di, hn::RebindMask(di, is_seen)), di, block.is_seen + i);
    hn::StoreU(hn::ConvertTo(di, whole_x), di, block.column + i);
    hn::StoreU(hn::ConvertTo(di, whole_y), di, block.line + i);
    store_weights(d, hn::Sub(x, whole_x), hn::Sub(y, whole_y), i, block.sums);
  }
  return hn::AllTrue(d, all_within);
}

// Sums over the lines for pixel i where taps may lie outside the image: gathers them first,
// replacing those outside by the nearest pixel.
template <int kChannels, typename T>
HWY_NOINLINE void sum_down_at_border(const RemapRow<T>& row, int i, Block& block) {
  T taps[4 * kTapLanes] = {};
  if (block.is_seen[i] != 0) {
    for (int j = 0; j < 4; ++j) {
      const int line = std::clamp(block.line[i] - 1 + j, 0, row.height - 1);
      for (int k = 0; k < 4; ++k) {
        const int column = std::clamp(block.column[i] - 1 + k, 0, row.width - 1);
        std::copy_n(row.pixels + line * row.stride + column * kChannels, kChannels,
                    taps + j * kTapLanes + k * kChannels);
      }
    }
  }
  sum_down<kChannels>(taps, kTapLanes, i, block.sums);
}

template <class D, typename T>
HWY_INLINE void store_values(D d, hn::VFromD<D> sum, T* values) {
  if constexpr (std::is_same_v<T, float>) {
    hn::StoreU(sum, d, values);
  } else {
    const hn::Rebind<std::int32_t, D> d32;
    const hn::Rebind<T, D> d_pixel;
    const auto rounded = hn::ConvertTo(d32, hn::Add(sum, hn::Set(d, 0.5F)));
    hn::StoreU(hn::DemoteTo(d_pixel, rounded), d_pixel, values);
  }
}

// Stores whole vectors of grey pixels.
template <class D, typename T>
HWY_INLINE void store_grey(D d, const TapSums& sums, int first, int count, T* values) {
  const int step = static_cast<int>(hn::Lanes(d));
  for (int i = first; i + step <= count; i += step) {
    store_values(d, sum_along_grey<T>(d, sums, i), values + i);
  }
}

// With three channels the fourth value falls on the next pixel, which is written afterwards.
template <int kChannels, typename T>
HWY_INLINE void store_colour(const TapSums& sums, int count, T* values) {
  const hn::FixedTag<float, 4> d;
  for (int i = 0; i < count; ++i) {
    store_values(d, sum_along_colour<kChannels, T>(sums, i), values + i * kChannels);
  }
}

template <int kChannels, typename T>
HWY_INLINE void remap_channels(const RemapRow<T>& row, T* HWY_RESTRICT result) {
  const hn::ScalableTag<float> d;
  const hn::FixedTag<float, 1> d_one;
  constexpr int kSpare = kPixelsReadBehind<kChannels>;
  HWY_ALIGN Block block;
  T values[kTapBlock * kChannels + 4];
  for (int begin = 0; begin < row.count; begin += kTapBlock) {
    const int count = std::min(kTapBlock, row.count - begin);
    const int whole_vectors = count - count % static_cast<int>(hn::Lanes(d));
    const bool all_within = locate(d, row, begin, 0, whole_vectors, kSpare, block) &
                            locate(d_one, row, begin, whole_vectors, count, kSpare, block);
    if (HWY_LIKELY(all_within)) {
      const T* pixels = row.pixels;
      const std::ptrdiff_t stride = row.stride;
      for (int i = 0; i < count; ++i) {
        const T* tap = pixels + (block.line[i] - 1) * stride + (block.column[i] - 1) * kChannels;
        sum_down<kChannels>(tap, stride, i, block.sums);
      }
    } else {
      for (int i = 0; i < count; ++i) {
        sum_down_at_border<kChannels>(row, i, block);
      }
    }
    if constexpr (kChannels == 1) {
      store_grey(d, block.sums, 0, whole_vectors, values);
      store_grey(d_one, block.sums, whole_vectors, count, values);
    } else {
      store_colour<kChannels>(block.sums, count, values);
    }
    std::memcpy(result + begin * kChannels, values,
                sizeof(T) * static_cast<std::size_t>(count) * kChannels);
  }
}

template <typename T>
HWY_INLINE void remap_any(const RemapRow<T>& row, T* result) {
  if (row.channels == 1) {
    remap_channels<1>(row, result);
  } else if (row.channels == 3) {
    remap_channels<3>(row, result);
  } else {
    remap_channels<4>(row, result);
  }
}

void remap_u8(const RemapRow<std::uint8_t>& row, std::uint8_t* result) { remap_any(row, result); }
void remap_u16(const RemapRow<std::uint16_t>& row, std::uint16_t* result) {
  remap_any(row, result);
}
void remap_f32(const RemapRow<float>& row, float* result) { remap_any(row, result); }

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(remap_u8);
HWY_EXPORT(remap_u16);
HWY_EXPORT(remap_f32);

void remap_bicubic_row(const RemapRow<std::uint8_t>& row, std::uint8_t* result) {
  HWY_DYNAMIC_DISPATCH(remap_u8)(row, result);
}
void remap_bicubic_row(const RemapRow<std::uint16_t>& row, std::uint16_t* result) {
  HWY_DYNAMIC_DISPATCH(remap_u16)(row, result);
}
void remap_bicubic_row(const RemapRow<float>& row, float* result) {
  HWY_DYNAMIC_DISPATCH(remap_f32)(row, result);
}

}  // namespace vantage::kernels
#endif
