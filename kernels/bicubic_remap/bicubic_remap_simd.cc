#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bicubic_remap/bicubic_remap_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "kernels/bicubic_remap/bicubic_remap.h"
#include "kernels/pixel_row/pixel_row.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR
// Has no vector of four lanes to hold the taps.
template <typename T>
void remap_any(const RemapRow<T>& row, T* result) {
  remap_bicubic_row_ref(row, result);
}
#else
namespace hn = hwy::HWY_NAMESPACE;

// New pixels that are worked on at a time, step by step; a multiple of every vector's length.
constexpr int kBlock = 64;
// Room for four taps of four channels.
constexpr int kTapLanes = 16;

// What the steps hand on. All of it stays in the level 1 cache.
struct Block {
  float weight_x[4][kBlock];
  float weight_y[4 * kBlock];          // the four of a pixel side by side
  std::int32_t column[kBlock];         // of the tap left of the position
  std::int32_t line[kBlock];           // of the tap above it
  std::int32_t is_seen[kBlock];        // other than 0: the position is in the image
  float sum_down[kTapLanes * kBlock];  // [i · taps + tap · channels + c], of the tap's four lines
  float least_down[kTapLanes * kBlock];  // for floats only
  float most_down[kTapLanes * kBlock];
};

template <class D>
struct KeysWeights {
  hn::VFromD<D> at[4];
};

template <class D>
HWY_INLINE KeysWeights<D> keys_weights(D d, hn::VFromD<D> f) {
  const auto half = hn::Set(d, 0.5F);
  const auto one = hn::Set(d, 1.0F);
  const auto half_f = hn::Mul(half, f);
  const auto squared = hn::Mul(f, f);
  const auto inner = hn::Mul(hn::Set(d, 1.5F), f);
  // Mul, Add and Sub, never fused: results must not depend on the instruction set.
  return {{hn::Mul(f, hn::Sub(hn::Mul(f, hn::Sub(one, half_f)), half)),
           hn::Add(hn::Mul(squared, hn::Sub(inner, hn::Set(d, 2.5F))), one),
           hn::Mul(f, hn::Add(hn::Mul(f, hn::Sub(hn::Set(d, 2.0F), inner)), half)),
           hn::Mul(squared, hn::Sub(half_f, half))}};
}

// Taps and weights of `count` pixels from `begin`. Returns whether all their taps lie in the image,
// with `spare` columns to the right of them.
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
    const auto weight_x = keys_weights(d, hn::Sub(x, whole_x));
    for (int tap = 0; tap < 4; ++tap) {
      hn::StoreU(weight_x.at[tap], d, block.weight_x[tap] + i);
    }
    const auto weight_y = keys_weights(d, hn::Sub(y, whole_y));
    hn::StoreInterleaved4(weight_y.at[0], weight_y.at[1], weight_y.at[2], weight_y.at[3], d,
                          block.weight_y + 4 * i);
  }
  return hn::AllTrue(d, all_within);
}

template <class D, typename T>
HWY_INLINE hn::VFromD<D> load_as_float(D d, const T* values) {
  if constexpr (std::is_same_v<T, float>) {
    return hn::LoadU(d, values);
  } else {
    const hn::Rebind<std::int32_t, D> d32;
    const hn::Rebind<T, D> d_pixel;
    return hn::ConvertTo(d, hn::PromoteTo(d32, hn::LoadU(d_pixel, values)));
  }
}

// Sums down the four lines of the four taps of pixel i, whose first is at `tap`.
template <int kChannels, typename T>
HWY_INLINE void sum_down(const T* HWY_RESTRICT tap, std::ptrdiff_t stride, int i, Block& block) {
  constexpr int kTaps = kChannels == 1 ? 4 : kTapLanes;  // those of three channels are 12
  const hn::CappedTag<float, kTaps> d;
  const float* weight = block.weight_y + 4 * i;
  const auto weight0 = hn::Set(d, weight[0]);
  const auto weight1 = hn::Set(d, weight[1]);
  const auto weight2 = hn::Set(d, weight[2]);
  const auto weight3 = hn::Set(d, weight[3]);
  for (int lane = 0; lane < 4 * kChannels; lane += static_cast<int>(hn::Lanes(d))) {
    const auto line0 = load_as_float(d, tap + lane);
    const auto line1 = load_as_float(d, tap + stride + lane);
    const auto line2 = load_as_float(d, tap + 2 * stride + lane);
    const auto line3 = load_as_float(d, tap + 3 * stride + lane);
    hn::StoreU(hn::Add(hn::Add(hn::Mul(weight0, line0), hn::Mul(weight1, line1)),
                       hn::Add(hn::Mul(weight2, line2), hn::Mul(weight3, line3))),
               d, block.sum_down + kTaps * i + lane);
    if constexpr (std::is_same_v<T, float>) {
      hn::StoreU(hn::Min(hn::Min(line0, line1), hn::Min(line2, line3)), d,
                 block.least_down + kTaps * i + lane);
      hn::StoreU(hn::Max(hn::Max(line0, line1), hn::Max(line2, line3)), d,
                 block.most_down + kTaps * i + lane);
    }
  }
}

// The same where taps may lie outside: they are gathered first, each with the nearest pixel's
// value.
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
  sum_down<kChannels>(taps, kTapLanes, i, block);
}

template <typename T, class D>
HWY_INLINE hn::VFromD<D> limited(D d, hn::VFromD<D> sum, hn::VFromD<D> least, hn::VFromD<D> most) {
  const auto smallest = hn::Min(hn::Zero(d), least);
  const auto largest = hn::Max(hn::Set(d, kLargestValue<T>), most);
  return hn::Min(hn::Max(sum, smallest), largest);
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

// Sums along the four taps of whole vectors of grey pixels.
template <class D, typename T>
HWY_INLINE void sum_along_grey(D d, const Block& block, int first, int count, T* values) {
  const int step = static_cast<int>(hn::Lanes(d));
  for (int i = first; i + step <= count; i += step) {
    hn::VFromD<D> tap0;
    hn::VFromD<D> tap1;
    hn::VFromD<D> tap2;
    hn::VFromD<D> tap3;
    hn::LoadInterleaved4(d, block.sum_down + 4 * i, tap0, tap1, tap2, tap3);
    const auto sum = hn::Add(hn::Add(hn::Mul(hn::LoadU(d, block.weight_x[0] + i), tap0),
                                     hn::Mul(hn::LoadU(d, block.weight_x[1] + i), tap1)),
                             hn::Add(hn::Mul(hn::LoadU(d, block.weight_x[2] + i), tap2),
                                     hn::Mul(hn::LoadU(d, block.weight_x[3] + i), tap3)));
    auto least = hn::Zero(d);
    auto most = least;
    if constexpr (std::is_same_v<T, float>) {
      hn::LoadInterleaved4(d, block.least_down + 4 * i, tap0, tap1, tap2, tap3);
      least = hn::Min(hn::Min(tap0, tap1), hn::Min(tap2, tap3));
      hn::LoadInterleaved4(d, block.most_down + 4 * i, tap0, tap1, tap2, tap3);
      most = hn::Max(hn::Max(tap0, tap1), hn::Max(tap2, tap3));
    }
    store_values(d, limited<T>(d, sum, least, most), values + i);
  }
}

// Sums along the four taps of colour pixels: one vector is one pixel. Of three channels the fourth
// value is the next pixel's first, which is written after it.
template <int kChannels, typename T>
HWY_INLINE void sum_along_colour(const Block& block, int count, T* values) {
  const hn::FixedTag<float, 4> d;
  for (int i = 0; i < count; ++i) {
    const auto tap = [&](const float* down, int k) {
      return hn::LoadU(d, down + kTapLanes * i + k * kChannels);
    };
    const auto weighted = [&](int k) {
      return hn::Mul(hn::Set(d, block.weight_x[k][i]), tap(block.sum_down, k));
    };
    const auto sum = hn::Add(hn::Add(weighted(0), weighted(1)), hn::Add(weighted(2), weighted(3)));
    auto least = hn::Zero(d);
    auto most = least;
    if constexpr (std::is_same_v<T, float>) {
      const float* down = block.least_down;
      least = hn::Min(hn::Min(tap(down, 0), tap(down, 1)), hn::Min(tap(down, 2), tap(down, 3)));
      down = block.most_down;
      most = hn::Max(hn::Max(tap(down, 0), tap(down, 1)), hn::Max(tap(down, 2), tap(down, 3)));
    }
    store_values(d, limited<T>(d, sum, least, most), values + i * kChannels);
  }
}

template <int kChannels, typename T>
HWY_INLINE void remap_channels(const RemapRow<T>& row, T* HWY_RESTRICT result) {
  const hn::ScalableTag<float> d;
  const hn::FixedTag<float, 1> d_one;
  constexpr int kTaps = kChannels == 1 ? 4 : kTapLanes;
  // sum_down() reads so many pixels behind the last tap.
  constexpr int kSpare = (kTaps - 4 * kChannels + kChannels - 1) / kChannels;
  HWY_ALIGN Block block;
  T values[kBlock * kChannels + 4];
  for (int begin = 0; begin < row.count; begin += kBlock) {
    const int count = std::min(kBlock, row.count - begin);
    const int whole_vectors = count - count % static_cast<int>(hn::Lanes(d));
    const bool all_within = locate(d, row, begin, 0, whole_vectors, kSpare, block) &
                            locate(d_one, row, begin, whole_vectors, count, kSpare, block);
    if (HWY_LIKELY(all_within)) {
      const T* pixels = row.pixels;
      const std::ptrdiff_t stride = row.stride;
      for (int i = 0; i < count; ++i) {
        const T* tap = pixels + (block.line[i] - 1) * stride + (block.column[i] - 1) * kChannels;
        sum_down<kChannels>(tap, stride, i, block);
      }
    } else {
      for (int i = 0; i < count; ++i) {
        sum_down_at_border<kChannels>(row, i, block);
      }
    }
    if constexpr (kChannels == 1) {
      sum_along_grey(d, block, 0, whole_vectors, values);
      sum_along_grey(d_one, block, whole_vectors, count, values);
    } else {
      sum_along_colour<kChannels>(block, count, values);
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
#endif

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
