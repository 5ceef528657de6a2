#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/colour_fetch/colour_fetch_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "kernels/colour_fetch/colour_fetch.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR
// Has no vector of four lanes to hold a pixel.
void fetch_bicubic(const BicubicFetchRow& row, float* colours) {
  fetch_bicubic_row_ref(row, colours);
}
#else
namespace hn = hwy::HWY_NAMESPACE;

struct Taps {
  const float* pixel[4];
};

// The rare case: a tap lies outside the image or on another surface.
HWY_NOINLINE Taps taps_on_surface(const BicubicFetchRow& row, int whole, float f, float d) {
  int tap[4] = {whole - 1, whole, whole + 1, whole + 2};
  bool on_surface[4];
  for (int k = 0; k < 4; ++k) {
    on_surface[k] = std::abs(row.source_disparity_px[tap[k]] - d) <= row.gradient_limit_px;
  }
  if (!on_surface[1] && !on_surface[2]) {
    tap[1] = tap[2] = std::clamp(f < 0.5F ? tap[1] : tap[2], 0, row.width - 1);
    on_surface[0] = on_surface[3] = false;
  } else if (!on_surface[1]) {
    tap[1] = tap[2];
    on_surface[0] = false;
  } else if (!on_surface[2]) {
    tap[2] = tap[1];
    on_surface[3] = false;
  }
  tap[0] = on_surface[0] ? tap[0] : tap[1];
  tap[3] = on_surface[3] ? tap[3] : tap[2];
  Taps taps;
  for (int k = 0; k < 4; ++k) {
    taps.pixel[k] = row.pixels + tap[k] * row.lanes;
  }
  return taps;
}

// Positions whose columns and weights are computed at a time; a multiple of every vector's length.
constexpr int kBlock = 64;

struct BlockWeights {
  std::int32_t whole[kBlock];  // floor of the column
  float fraction[kBlock];
  float weight[4][kBlock];
};

// Source columns n + s·d and tap weights for `count` positions from `begin`; meaningless at holes.
template <class D64>
HWY_INLINE void weigh_taps(D64 d64, const BicubicFetchRow& row, int begin, int first, int count,
                           BlockWeights& block) {
  const hn::Rebind<float, D64> d32;
  const hn::Rebind<std::int32_t, D64> di32;
  const auto offset = hn::Set(d64, row.camera_offset);
  const auto least = hn::Set(d64, -1.0);
  const auto most = hn::Set(d64, row.width - 0.5);
  const auto half = hn::Set(d32, 0.5F);
  const auto one = hn::Set(d32, 1.0F);
  const auto one_and_half = hn::Set(d32, 1.5F);
  const int step = static_cast<int>(hn::Lanes(d64));
  for (int i = first; i + step <= count; i += step) {
    const auto read = hn::LoadU(d32, row.warped_disparity_px + begin + i);
    const auto d = hn::IfThenElseZero(hn::Eq(read, read), read);
    // Not Iota(d64, begin + i): only a constant start avoids a detour through memory.
    const auto position = hn::Add(hn::Iota(d64, 0), hn::Set(d64, begin + i));
    const auto exact = hn::Add(position, hn::Mul(offset, hn::PromoteTo(d64, d)));
    const auto column = hn::Min(hn::Max(exact, least), most);
    const auto whole = hn::Floor(column);
    hn::StoreU(hn::DemoteTo(di32, whole), di32, block.whole + i);
    const auto f = hn::DemoteTo(d32, hn::Sub(column, whole));
    hn::StoreU(f, d32, block.fraction + i);
    // Mul, Add and Sub, never fused: results must not depend on the instruction set.
    const auto half_f = hn::Mul(half, f);
    const auto squared = hn::Mul(f, f);
    const auto inner = hn::Mul(one_and_half, f);
    const auto weight0 = hn::Mul(f, hn::Sub(hn::Mul(f, hn::Sub(one, half_f)), half));
    const auto weight1 = hn::Add(hn::Mul(squared, hn::Sub(inner, hn::Set(d32, 2.5F))), one);
    const auto weight2 = hn::Mul(f, hn::Add(hn::Mul(f, hn::Sub(hn::Set(d32, 2.0F), inner)), half));
    const auto weight3 = hn::Mul(squared, hn::Sub(half_f, half));
    hn::StoreU(weight0, d32, block.weight[0] + i);
    hn::StoreU(weight1, d32, block.weight[1] + i);
    hn::StoreU(weight2, d32, block.weight[2] + i);
    hn::StoreU(weight3, d32, block.weight[3] + i);
  }
}

// One vector is one pixel: its four taps are neighbours in memory, so nothing is gathered.
template <class D>
HWY_INLINE void fetch_any(D d_pixel, const BicubicFetchRow& row, float* HWY_RESTRICT colours) {
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  const hn::ScalableTag<double> d64;
  const hn::FixedTag<double, 1> d64_one;
  const hn::FixedTag<float, 4> d_taps;
  const auto limit = hn::Set(d_taps, row.gradient_limit_px);
  const auto zero = hn::Zero(d_pixel);
  const auto largest_value = hn::Set(d_pixel, row.largest_value);

  HWY_ALIGN BlockWeights block;
  for (int begin = 0; begin < row.width; begin += kBlock) {
    const int count = std::min(kBlock, row.width - begin);
    const int whole_vectors = count - count % static_cast<int>(hn::Lanes(d64));
    weigh_taps(d64, row, begin, 0, whole_vectors, block);
    weigh_taps(d64_one, row, begin, whole_vectors, count, block);
    for (int i = 0; i < count; ++i, colours += kLanes) {
      const float d = row.warped_disparity_px[begin + i];
      if (d != d) {
        hn::StoreU(zero, d_pixel, colours);
        continue;
      }
      const int whole = block.whole[i];
      const auto difference = hn::Abs(
          hn::Sub(hn::LoadU(d_taps, row.source_disparity_px + whole - 1), hn::Set(d_taps, d)));
      const float* first = row.pixels + (whole - 1) * kLanes;
      Taps taps = {{first, first + kLanes, first + 2 * kLanes, first + 3 * kLanes}};
      if (HWY_UNLIKELY(!hn::AllTrue(d_taps, hn::Le(difference, limit)))) {
        taps = taps_on_surface(row, whole, block.fraction[i], d);
      }
      const auto value0 = hn::LoadU(d_pixel, taps.pixel[0]);
      const auto value1 = hn::LoadU(d_pixel, taps.pixel[1]);
      const auto value2 = hn::LoadU(d_pixel, taps.pixel[2]);
      const auto value3 = hn::LoadU(d_pixel, taps.pixel[3]);
      const auto sum = hn::Add(hn::Add(hn::Mul(hn::Set(d_pixel, block.weight[0][i]), value0),
                                       hn::Mul(hn::Set(d_pixel, block.weight[1][i]), value1)),
                               hn::Add(hn::Mul(hn::Set(d_pixel, block.weight[2][i]), value2),
                                       hn::Mul(hn::Set(d_pixel, block.weight[3][i]), value3)));
      const auto smallest =
          hn::Min(zero, hn::Min(hn::Min(value0, value1), hn::Min(value2, value3)));
      const auto largest =
          hn::Max(largest_value, hn::Max(hn::Max(value0, value1), hn::Max(value2, value3)));
      hn::StoreU(hn::Min(hn::Max(sum, smallest), largest), d_pixel, colours);
    }
  }
}

void fetch_bicubic(const BicubicFetchRow& row, float* colours) {
  if (row.lanes == 1) {
    fetch_any(hn::FixedTag<float, 1>(), row, colours);
  } else {
    fetch_any(hn::FixedTag<float, 4>(), row, colours);
  }
}
#endif

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(fetch_bicubic);

void fetch_bicubic_row(const BicubicFetchRow& row, float* colours) {
  HWY_DYNAMIC_DISPATCH(fetch_bicubic)(row, colours);
}

}  // namespace vantage::kernels
#endif
