#include "kernels/simd-inl.h"

#include <cstddef>

#include "kernels/gradient/gradient.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag = hn::ScalableTag<float>;

// sums[k] = Σ taps[i] · sources[i][k].
HWY_INLINE void weighted_sum(const std::array<const float*, 5>& sources, const FilterTaps& taps,
                             int count, float* sums) {
  const Tag d;
  const std::array<const float*, 5> from = sources;
  const FilterTaps weights = taps;
  for (int k = 0; k < count; k += static_cast<int>(hn::Lanes(d))) {
    auto sum = hn::Mul(hn::Set(d, weights[0]), hn::LoadU(d, from[0] + k));
#pragma GCC unroll 4
    for (std::size_t i = 1; i < 5; ++i) {
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[i]), hn::LoadU(d, from[i] + k)));
    }
    hn::StoreU(sum, d, sums + k);
  }
}

void separable_filter(const SeparableFilter& filter, float* work, float* filtered) {
  std::array<const float*, 5> rows = filter.rows;
  for (const float*& row : rows) {
    row -= kFilterRadius;
  }
  weighted_sum(rows, filter.down, filter.width + 2 * kFilterRadius, work);
  weighted_sum({work, work + 1, work + 2, work + 3, work + 4}, filter.along, filter.width,
               filtered);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(separable_filter);

void separable_filter_row(const SeparableFilter& filter, float* work, float* filtered) {
  HWY_DYNAMIC_DISPATCH(separable_filter)(filter, work, filtered);
}

}  // namespace vantage::kernels
#endif
