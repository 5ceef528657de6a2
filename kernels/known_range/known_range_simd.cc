#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>

#include "kernels/known_range/known_range.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

KnownRange known_range(const float* disparity_px, int count, KnownRange range) {
  const hn::ScalableTag<float> d;
  const int step = static_cast<int>(hn::Lanes(d));
  const auto largest = hn::Set(d, std::numeric_limits<float>::max());
  const auto infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  auto min = infinity;
  auto max = hn::Neg(infinity);
  int i = 0;
  for (; i + step <= count; i += step) {
    const auto read = hn::LoadU(d, disparity_px + i);
    const auto known = hn::Le(hn::Abs(read), largest);
    min = hn::Min(min, hn::IfThenElse(known, read, infinity));
    max = hn::Max(max, hn::IfThenElse(known, read, hn::Neg(infinity)));
  }
  const float min_of_vectors = hn::GetLane(hn::MinOfLanes(d, min));
  const float max_of_vectors = hn::GetLane(hn::MaxOfLanes(d, max));
  range.min = range.min < min_of_vectors ? range.min : min_of_vectors;
  range.max = range.max > max_of_vectors ? range.max : max_of_vectors;
  return known_range_row_ref(disparity_px + i, count - i, range);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(known_range);

KnownRange known_range_row(const float* disparity_px, int count, KnownRange range) {
  return HWY_DYNAMIC_DISPATCH(known_range)(disparity_px, count, range);
}

// Scalar reference.

KnownRange known_range_row_ref(const float* disparity_px, int count, KnownRange range) {
  for (int i = 0; i < count; ++i) {
    if (std::isfinite(disparity_px[i])) {
      range.min = std::min(range.min, disparity_px[i]);
      range.max = std::max(range.max, disparity_px[i]);
    }
  }
  return range;
}

}  // namespace vantage::kernels
#endif
