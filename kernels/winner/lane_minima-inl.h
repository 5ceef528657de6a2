// Reduces per-lane minima of cell columns. Included once per target by dispatched files.

#if defined(VANTAGE_KERNELS_LANE_MINIMA_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_LANE_MINIMA_INL_H_
#undef VANTAGE_KERNELS_LANE_MINIMA_INL_H_
#else
#define VANTAGE_KERNELS_LANE_MINIMA_INL_H_
#endif

#include <cstdint>

#include "kernels/candidates.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// first, first + 1, … per lane. Highway's Iota is a constant only for a constant start; otherwise
// it goes through memory, value by value.
HWY_INLINE auto lane_numbers(int first) {
  const hn::ScalableTag<std::int32_t> d32;
  return hn::Add(hn::Iota(d32, 0), hn::Set(d32, first));
}

// Minima of kColumns work columns, by transposition: neighbouring lanes of two vectors are merged
// into one until lane k of the last vector belongs to column k.
template <int kColumns>
HWY_INLINE auto minima_of(const std::int32_t* work) {
  const hn::ScalableTag<std::int32_t> d32;
  if constexpr (kColumns == 1) {
    return hn::LoadU(d32, work);
  } else {
    const auto low = minima_of<kColumns / 2>(work);
    const auto high = minima_of<kColumns / 2>(work + kColumns / 2 * kLaneMultiple);
    return hn::Min(hn::ConcatEven(d32, high, low), hn::ConcatOdd(d32, high, low));
  }
}

// minima[j] = minimum of the first Lanes(int32) values of work column j; columns are kLaneMultiple
// values apart.
HWY_INLINE void reduce_minima(const std::int32_t* work, int columns, std::int32_t* minima) {
  const hn::ScalableTag<std::int32_t> d32;
  int j = 0;
  constexpr int step = static_cast<int>(hn::MaxLanes(d32));
  for (; j + step <= columns; j += step, work += step * kLaneMultiple) {
    hn::StoreU(minima_of<step>(work), d32, minima + j);
  }
  for (; j < columns; ++j, work += kLaneMultiple) {
    minima[j] = hn::GetLane(hn::MinOfLanes(d32, hn::LoadU(d32, work)));
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
