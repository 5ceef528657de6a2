#include "kernels/simd-inl.h"

#include <cmath>
#include <cstddef>

#include "kernels/candidates.h"
#include "kernels/column_ssd/column_ssd.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag32 = hn::ScalableTag<std::int32_t>;
using Vec32 = hn::VFromD<Tag32>;
using TagFloat = hn::ScalableTag<float>;

void interleave(const std::uint8_t* entering, const std::uint8_t* leaving, int shift, int count,
                std::int32_t* pairs) {
  const Tag32 d32;
  const hn::Rebind<std::uint8_t, Tag32> d8;
  const auto load = [&](const std::uint8_t* pixels, int k) HWY_ATTR {
    return pixels != nullptr ? hn::PromoteTo(d32, hn::LoadU(d8, pixels + k)) : hn::Zero(d32);
  };
  for (int k = 0; k < count; k += static_cast<int>(hn::Lanes(d32))) {
    const Vec32 low = hn::ShiftLeftSame(load(entering, k), shift);
    const Vec32 high = hn::ShiftLeftSame(load(leaving, k), shift + 16);
    hn::StoreU(hn::Or(low, high), d32, pairs + k);
  }
}

// sum + entering² − leaving², where the 16-bit halves of a − b are (entering, leaving).
HWY_INLINE Vec32 add_change(Vec32 a, Vec32 b, Vec32 sum) {
  const Tag32 d32;
  const hn::Repartition<std::int16_t, Tag32> d16;
  const auto difference = hn::Sub(hn::BitCast(d16, a), hn::BitCast(d16, b));
  // (entering, leaving) · (1, −1). Subtracting from a second, negated row of pairs would save this
  // product but cost a load across cache lines, which is slower.
  const auto signs = hn::BitCast(d16, hn::Set(d32, static_cast<std::int32_t>(0xFFFF0001U)));
  Vec32 more = hn::Zero(d32);
  const Vec32 change = hn::ReorderWidenMulAccumulate(d32, difference, hn::Mul(difference, signs),
                                                     hn::Zero(d32), more);
  return hn::Add(sum, hn::RearrangeToOddPlusEven(change, more));
}

// Processes kVectors neighbouring vectors of lanes over all columns.
template <int kVectors>
HWY_INLINE void pair_lanes(const ColumnSsdPairs& row, const std::int32_t* previous,
                           std::int32_t* sums, int first_lane) {
  const Tag32 d32;
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(hn::Lanes(d32));
  const std::ptrdiff_t lanes = row.lanes;
  const std::ptrdiff_t partner_step = row.partner_step;
  const std::int32_t* partner = row.partner + first_lane;
  const std::int32_t* const reference_end = row.reference + row.columns;
  previous += first_lane;
  sums += first_lane;
  for (const std::int32_t* reference = row.reference; reference < reference_end; ++reference) {
    const Vec32 pixel = hn::Set(d32, *reference);
#pragma GCC unroll 4
    for (int v = 0; v < kVectors; ++v) {
      hn::StoreU(add_change(pixel, hn::LoadU(d32, partner + v * step),
                            hn::LoadU(d32, previous + v * step)),
                 d32, sums + v * step);
    }
    partner += partner_step;
    previous += lanes;
    sums += lanes;
  }
}

void column_ssd_pairs(const ColumnSsdPairs& row, const std::int32_t* previous, std::int32_t* sums) {
  const int step = static_cast<int>(hn::Lanes(Tag32()));
  int lane = 0;
  for (; lane + 4 * step <= row.lanes; lane += 4 * step) {
    pair_lanes<4>(row, previous, sums, lane);
  }
  for (; lane < row.lanes; lane += step) {
    pair_lanes<1>(row, previous, sums, lane);
  }
}

// A float in [2²³, 2²⁴) is an integer, and its bits increase by one from each integer to the next.
// Adding this constant rounds a square to an integer; differences of bits are then differences of
// rounded squares.
constexpr float kRounder = 12582912.0F;  // 1.5 · 2²³

HWY_INLINE Vec32 square_bits(hn::VFromD<TagFloat> reference, const float* partner) {
  const TagFloat df;
  const auto difference = hn::Sub(reference, hn::LoadU(df, partner));
  const auto square = hn::Mul(difference, difference);
  return hn::BitCast(Tag32(), hn::Add(square, hn::Set(df, kRounder)));
}

template <int kVectors, bool kEntering, bool kLeaving>
HWY_INLINE void float_lanes(const ColumnSsdFloat& row, const std::int32_t* previous,
                            std::int32_t* sums, int first_lane) {
  const Tag32 d32;
  const TagFloat df;
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(hn::Lanes(d32));
  const std::ptrdiff_t lanes = row.lanes;
  const std::ptrdiff_t partner_step = row.partner_step;
  const float* entering = row.partner_entering + (kEntering ? first_lane : 0);
  const float* leaving = row.partner_leaving + (kLeaving ? first_lane : 0);
  const int columns = row.columns;
  previous += first_lane;
  sums += first_lane;
  for (int j = 0; j < columns; ++j) {
    const auto entering_pixel = hn::Set(df, kEntering ? row.reference_entering[j] : 0.0F);
    const auto leaving_pixel = hn::Set(df, kLeaving ? row.reference_leaving[j] : 0.0F);
#pragma GCC unroll 4
    for (int v = 0; v < kVectors; ++v) {
      const Vec32 zero_bits = hn::BitCast(d32, hn::Set(df, kRounder));
      const Vec32 enters = kEntering ? square_bits(entering_pixel, entering + v * step) : zero_bits;
      const Vec32 leaves = kLeaving ? square_bits(leaving_pixel, leaving + v * step) : zero_bits;
      const Vec32 sum = hn::Add(hn::LoadU(d32, previous + v * step), hn::Sub(enters, leaves));
      hn::StoreU(sum, d32, sums + v * step);
    }
    entering += kEntering ? partner_step : 0;
    leaving += kLeaving ? partner_step : 0;
    previous += lanes;
    sums += lanes;
  }
}

template <bool kEntering, bool kLeaving>
HWY_INLINE void column_ssd_float_any(const ColumnSsdFloat& row, const std::int32_t* previous,
                                     std::int32_t* sums) {
  const int step = static_cast<int>(hn::Lanes(Tag32()));
  int lane = 0;
  for (; lane + 4 * step <= row.lanes; lane += 4 * step) {
    float_lanes<4, kEntering, kLeaving>(row, previous, sums, lane);
  }
  for (; lane < row.lanes; lane += step) {
    float_lanes<1, kEntering, kLeaving>(row, previous, sums, lane);
  }
}

void column_ssd_float(const ColumnSsdFloat& row, const std::int32_t* previous, std::int32_t* sums) {
  const bool entering = row.reference_entering != nullptr;
  const bool leaving = row.reference_leaving != nullptr;
  if (entering && leaving) {
    column_ssd_float_any<true, true>(row, previous, sums);
  } else if (entering) {
    column_ssd_float_any<true, false>(row, previous, sums);
  } else if (leaving) {
    column_ssd_float_any<false, true>(row, previous, sums);
  } else {
    column_ssd_float_any<false, false>(row, previous, sums);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(interleave);
HWY_EXPORT(column_ssd_pairs);
HWY_EXPORT(column_ssd_float);

void interleave_rows(const std::uint8_t* entering, const std::uint8_t* leaving, int shift,
                     int count, std::int32_t* pairs) {
  HWY_DYNAMIC_DISPATCH(interleave)(entering, leaving, shift, count, pairs);
}
void column_ssd_row(const ColumnSsdPairs& row, const std::int32_t* previous, std::int32_t* sums) {
  HWY_DYNAMIC_DISPATCH(column_ssd_pairs)(row, previous, sums);
}
void column_ssd_row(const ColumnSsdFloat& row, const std::int32_t* previous, std::int32_t* sums) {
  HWY_DYNAMIC_DISPATCH(column_ssd_float)(row, previous, sums);
}

}  // namespace vantage::kernels
#endif
