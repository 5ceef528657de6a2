#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/known_range/known_range_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include "kernels/known_range/known_range.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

KnownRange known_range(const float* disparity_px, int count, KnownRange range) {
  const hn::ScalableTag<float> d;
  const int step = static_cast<int>(hn::Lanes(d));
  const auto largest = hn::Set(d, std::numeric_limits<float>::max());
  const auto infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  auto least = infinity;
  auto most = hn::Neg(infinity);
  int i = 0;
  for (; i + step <= count; i += step) {
    const auto read = hn::LoadU(d, disparity_px + i);
    const auto known = hn::Le(hn::Abs(read), largest);
    least = hn::Min(least, hn::IfThenElse(known, read, infinity));
    most = hn::Max(most, hn::IfThenElse(known, read, hn::Neg(infinity)));
  }
  const float least_of_vectors = hn::GetLane(hn::MinOfLanes(d, least));
  const float most_of_vectors = hn::GetLane(hn::MaxOfLanes(d, most));
  range.least = range.least < least_of_vectors ? range.least : least_of_vectors;
  range.most = range.most > most_of_vectors ? range.most : most_of_vectors;
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

}  // namespace vantage::kernels
#endif
