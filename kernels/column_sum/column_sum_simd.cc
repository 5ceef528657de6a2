#include "kernels/simd-inl.h"

#include <cmath>
#include <cstddef>

#include "kernels/column_sum/column_sum.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag32 = hn::ScalableTag<std::int32_t>;
using Vec32 = hn::VFromD<Tag32>;
using TagFloat = hn::ScalableTag<float>;
using VecFloat = hn::VFromD<TagFloat>;

// A float in [2²³, 2²⁴) is an integer, and its bits increase by one from each integer to the next.
// Adding this constant rounds a cost to an integer; differences of bits are then differences of
// rounded costs.
constexpr float kRounder = 12582912.0F;  // 1.5 · 2²³

HWY_INLINE Vec32 cost_bits(const float* costs, VecFloat offset, VecFloat scale) {
  const TagFloat df;
  const VecFloat cost = hn::Mul(hn::Add(hn::LoadU(df, costs), offset), scale);
  return hn::BitCast(Tag32(), hn::Add(cost, hn::Set(df, kRounder)));
}

template <bool kEntering, bool kLeaving>
HWY_INLINE void column_sum_any(const ColumnSum& row, const std::int32_t* previous,
                               std::int32_t* sums) {
  const Tag32 d32;
  const TagFloat df;
  constexpr std::ptrdiff_t step = static_cast<std::ptrdiff_t>(hn::MaxLanes(d32));
  const float* const entering = row.entering;
  const float* const leaving = row.leaving;
  const VecFloat offset = hn::Set(df, row.offset);
  const VecFloat scale = hn::Set(df, row.scale);
  const Vec32 zero_bits = hn::BitCast(d32, hn::Set(df, kRounder));
  for (std::ptrdiff_t i = 0; i < row.count; i += step) {
    const Vec32 enters = kEntering ? cost_bits(entering + i, offset, scale) : zero_bits;
    const Vec32 leaves = kLeaving ? cost_bits(leaving + i, offset, scale) : zero_bits;
    hn::StoreU(hn::Add(hn::LoadU(d32, previous + i), hn::Sub(enters, leaves)), d32, sums + i);
  }
}

void column_sum(const ColumnSum& row, const std::int32_t* previous, std::int32_t* sums) {
  if (row.entering != nullptr && row.leaving != nullptr) {
    column_sum_any<true, true>(row, previous, sums);
  } else if (row.entering != nullptr) {
    column_sum_any<true, false>(row, previous, sums);
  } else if (row.leaving != nullptr) {
    column_sum_any<false, true>(row, previous, sums);
  } else {
    column_sum_any<false, false>(row, previous, sums);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(column_sum);

void column_sum_row(const ColumnSum& row, const std::int32_t* previous, std::int32_t* sums) {
  HWY_DYNAMIC_DISPATCH(column_sum)(row, previous, sums);
}

}  // namespace vantage::kernels
#endif
