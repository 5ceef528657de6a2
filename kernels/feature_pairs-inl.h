// The loop over columns and lanes that all matching costs share. Included once per target by
// dispatched files.

#if defined(VANTAGE_KERNELS_FEATURE_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VANTAGE_KERNELS_FEATURE_PAIRS_INL_H_
#undef VANTAGE_KERNELS_FEATURE_PAIRS_INL_H_
#else
#define VANTAGE_KERNELS_FEATURE_PAIRS_INL_H_
#endif

#include <algorithm>
#include <array>
#include <cstddef>

#include "kernels/feature_pairs.h"
#include "kernels/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Values of one channel's planes at one column, or for one vector of candidates.
template <typename T, int kPlanes>
using Features = std::array<hn::VFromD<hn::ScalableTag<T>>, kPlanes>;

// Processes kVectors neighbouring vectors of lanes over all columns. `compare` maps the features of
// reference and partner to a float vector; its finish() maps the mean over the channels to cells.
template <int kVectors, int kChannels, bool kClear, typename T, int kPlanes, typename Compare>
HWY_INLINE void compare_lanes(const FeaturePairs<T, kPlanes>& row, const Compare& compare,
                              int first_lane, float* cells) {
  const hn::ScalableTag<T> d;
  const hn::ScalableTag<float> df;
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(hn::Lanes(df));
  const std::ptrdiff_t lanes = row.lanes;
  const std::ptrdiff_t partner_step = row.partner_step;
  const int columns = row.columns;
  const T* reference[kChannels][kPlanes];
  const T* partner[kChannels][kPlanes];
#pragma GCC unroll 3
  for (int c = 0; c < kChannels; ++c) {
#pragma GCC unroll 3
    for (int p = 0; p < kPlanes; ++p) {
      reference[c][p] = row.channel[c].reference[p];
      partner[c][p] = row.channel[c].partner[p] + first_lane;
    }
  }
  using Mask = decltype(hn::FirstN(df, 0));
  Mask is_candidate[kVectors];
#pragma GCC unroll 4
  for (int v = 0; v < kVectors; ++v) {
    is_candidate[v] = hn::FirstN(df, static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
                                         row.count - first_lane - v * step, 0, step)));
  }
  cells += first_lane;
  std::ptrdiff_t k = 0;
  for (int j = 0; j < columns; ++j, k += partner_step, cells += lanes) {
    Features<T, kPlanes> pixel[kChannels];
#pragma GCC unroll 3
    for (int c = 0; c < kChannels; ++c) {
#pragma GCC unroll 3
      for (int p = 0; p < kPlanes; ++p) {
        pixel[c][p] = hn::Set(d, reference[c][p][j]);
      }
    }
#pragma GCC unroll 4
    for (int v = 0; v < kVectors; ++v) {
      hn::VFromD<decltype(df)> sum = hn::Zero(df);
#pragma GCC unroll 3
      for (int c = 0; c < kChannels; ++c) {
        Features<T, kPlanes> candidates;
#pragma GCC unroll 3
        for (int p = 0; p < kPlanes; ++p) {
          candidates[p] = hn::LoadU(d, partner[c][p] + k + v * step);
        }
        const auto cost = compare(pixel[c], candidates);
        sum = c == 0 ? cost : hn::Add(sum, cost);
      }
      if (kChannels > 1) {
        sum = hn::Mul(sum, hn::Set(df, 1.0F / kChannels));
      }
      sum = compare.finish(sum);
      hn::StoreU(kClear ? hn::IfThenElseZero(is_candidate[v], sum) : sum, df, cells + v * step);
    }
  }
}

template <int kChannels, bool kClearBehind, typename T, int kPlanes, typename Compare>
HWY_INLINE void compare_columns(const FeaturePairs<T, kPlanes>& row, const Compare& compare,
                                float* cells) {
  const int step = static_cast<int>(hn::Lanes(hn::ScalableTag<float>()));
  int lane = 0;
  const int unclear = kClearBehind ? row.count : row.lanes;
  for (; lane + 4 * step <= unclear; lane += 4 * step) {
    compare_lanes<4, kChannels, false>(row, compare, lane, cells);
  }
  for (; lane + 4 * step <= row.lanes; lane += 4 * step) {
    compare_lanes<4, kChannels, kClearBehind>(row, compare, lane, cells);
  }
  for (; lane < row.lanes; lane += step) {
    compare_lanes<1, kChannels, kClearBehind>(row, compare, lane, cells);
  }
}

// Computes all cells of `row`. kClearBehind: writes 0 to lanes ≥ row.count.
template <bool kClearBehind, typename T, int kPlanes, typename Compare>
HWY_INLINE void compare_row(const FeaturePairs<T, kPlanes>& row, const Compare& compare,
                            float* cells) {
  if (row.channels == 1) {
    compare_columns<1, kClearBehind>(row, compare, cells);
  } else {
    compare_columns<3, kClearBehind>(row, compare, cells);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
