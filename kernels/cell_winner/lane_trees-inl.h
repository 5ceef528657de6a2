// Reduces per-lane results of several cell columns together. Included once per target by dispatched
// files.

#if defined(VANTAGE_KERNELS_LANE_TREES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_LANE_TREES_INL_H_
#undef VANTAGE_KERNELS_LANE_TREES_INL_H_
#else
#define VANTAGE_KERNELS_LANE_TREES_INL_H_
#endif

#include "kernels/candidates.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using TagF = hn::ScalableTag<float>;
using VecF = hn::VFromD<TagF>;
constexpr int kStep = static_cast<int>(hn::MaxLanes(TagF()));
/// Vectors that hold one value for each of kLaneMultiple lanes.
constexpr int kParts = kLaneMultiple / kStep;

struct Sum {
  static HWY_INLINE VecF joined(VecF a, VecF b) { return hn::Add(a, b); }
};
struct Minimum {
  static HWY_INLINE VecF joined(VecF a, VecF b) { return hn::Min(a, b); }
};

// Every second lane of `low` followed by `high`, starting at the first lane (even) or the second
// (odd).
HWY_INLINE VecF even_lanes(VecF low, VecF high) { return hn::ConcatEven(TagF(), high, low); }
HWY_INLINE VecF odd_lanes(VecF low, VecF high) { return hn::ConcatOdd(TagF(), high, low); }

// Joins neighbours among kCount vectors of values until one vector is left. `values` holds kCount
// values for each of kStep columns, column by column; lane k of the result is the result of column
// k. The tree over a column's values is the same for every kStep.
template <class Operation, int kCount>
HWY_INLINE VecF joined_lanes(const float* values) {
  if constexpr (kCount == 1) {
    return hn::Load(TagF(), values);
  } else {
    const VecF low = joined_lanes<Operation, kCount / 2>(values);
    const VecF high = joined_lanes<Operation, kCount / 2>(values + kCount / 2 * kStep);
    return Operation::joined(even_lanes(low, high), odd_lanes(low, high));
  }
}

/// The smallest and second smallest of some values.
struct TwoSmallest {
  VecF min;
  VecF second;
};

// Same for values that are given as pairs (smallest, second smallest).
template <int kCount>
HWY_INLINE TwoSmallest joined_two_smallest(const float* min, const float* second) {
  if constexpr (kCount == 1) {
    return {hn::Load(TagF(), min), hn::Load(TagF(), second)};
  } else {
    constexpr int half = kCount / 2 * kStep;
    const TwoSmallest low = joined_two_smallest<kCount / 2>(min, second);
    const TwoSmallest high = joined_two_smallest<kCount / 2>(min + half, second + half);
    const VecF even = even_lanes(low.min, high.min);
    const VecF odd = odd_lanes(low.min, high.min);
    const VecF seconds =
        hn::Min(even_lanes(low.second, high.second), odd_lanes(low.second, high.second));
    return {hn::Min(even, odd), hn::Min(hn::Max(even, odd), seconds)};
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
