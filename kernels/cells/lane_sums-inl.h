// Sums, minima and maxima over the lanes of a cell column, in an order that does not depend on the
// vector length. Included once per target by dispatched files.

#if defined(VANTAGE_KERNELS_LANE_SUMS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_LANE_SUMS_INL_H_
#undef VANTAGE_KERNELS_LANE_SUMS_INL_H_
#else
#define VANTAGE_KERNELS_LANE_SUMS_INL_H_
#endif

#include "kernels/candidates.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using FloatTag = hn::ScalableTag<float>;
using FloatVec = hn::VFromD<FloatTag>;

inline constexpr int kFloatLanes = static_cast<int>(hn::MaxLanes(FloatTag()));
/// Vectors that hold kLaneMultiple lanes.
inline constexpr int kParts = kLaneMultiple / kFloatLanes;
static_assert(kParts * kFloatLanes == kLaneMultiple);

/// kLaneMultiple partial results, one per lane of a block of a cell column.
struct LaneBlock16 {
  FloatVec part[kParts];

  HWY_INLINE void fill(FloatVec value) {
    for (int p = 0; p < kParts; ++p) {
      part[p] = value;
    }
  }
};

/// Reduces the lanes of `block` by the tree ((l + (l+8)) + (l+4)) + …; the result is in every lane.
template <class Operation>
HWY_INLINE FloatVec fold_lanes(LaneBlock16 block, Operation operation) {
  for (int half = kParts / 2; half >= 1; half /= 2) {
    for (int p = 0; p < half; ++p) {
      block.part[p] = operation(block.part[p], block.part[p + half]);
    }
  }
  FloatVec all = block.part[0];
  if constexpr (kFloatLanes >= 16) {
    all = operation(all, hn::ConcatLowerUpper(FloatTag(), all, all));
  }
  if constexpr (kFloatLanes >= 8) {
    all = operation(all, hn::SwapAdjacentBlocks(all));
  }
  all = operation(all, hn::Shuffle1032(all));
  all = operation(all, hn::Shuffle2301(all));
  return all;
}

HWY_INLINE FloatVec sum_lanes(const LaneBlock16& block) {
  return fold_lanes(block, [](FloatVec a, FloatVec b) HWY_ATTR { return hn::Add(a, b); });
}

HWY_INLINE FloatVec max_lanes(const LaneBlock16& block) {
  return fold_lanes(block, [](FloatVec a, FloatVec b) HWY_ATTR { return hn::Max(a, b); });
}

HWY_INLINE FloatVec min_lanes(const LaneBlock16& block) {
  return fold_lanes(block, [](FloatVec a, FloatVec b) HWY_ATTR { return hn::Min(a, b); });
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
