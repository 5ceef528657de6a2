#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "kernels/candidates.h"
#include "kernels/row_sum/row_sum.h"
#include "kernels/winner/lane_minima-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag32 = hn::ScalableTag<std::int32_t>;
using Vec32 = hn::VFromD<Tag32>;

// Contribution of a block of lanes to the minima: none, the first or a further part.
enum class Minima { kNone, kBegin, kContinue };

// Processes kVectors neighbouring vectors of lanes over all columns. The running sums stay in
// registers; a column's lanes are accessed in whole cache lines.
template <int kVectors, bool kStore, Minima kMinima, bool kPadded>
class LaneBlock {
 public:
  HWY_INLINE LaneBlock(const RowSum& row, int first_lane)
      : row_(row),
        first_lane_(first_lane),
        lanes_(row.lanes),
        output_(kStore ? row.output + first_lane : nullptr),
        minima_(row.minima_work) {
    const Tag32 d32;
    for (int v = 0; v < kVectors; ++v) {
      const int lane = first_lane + v * kStep;
      sum_[v] = row.continues      ? hn::LoadU(d32, row.window_sums + lane)
                : row.number_lanes ? lane_numbers(lane)
                                   : hn::Zero(d32);
      // Raises lanes ≥ candidates above all others; leaves the rest unchanged.
      const auto is_candidate = hn::Lt(lane_numbers(lane), hn::Set(d32, row.candidates));
      floor_[v] =
          hn::IfThenElse(is_candidate, hn::Set(d32, std::numeric_limits<std::int32_t>::min()),
                         hn::Set(d32, std::numeric_limits<std::int32_t>::max()));
    }
  }

  HWY_INLINE void run() {
    const int radius = row_.radius;
    const int begin = row_.output_begin;
    const int end = row_.output_end;
    // The columns of the first window, except the last one, are added before the first output.
    const int window_begin = std::max(begin - radius, row_.input_begin);
    const int window_end = std::min(begin + radius, row_.input_end);
    // From here on a column leaves: the first one added to a new window, or the one before it.
    const int leave_from = row_.continues ? std::clamp(row_.input_begin + radius + 1, begin, end)
                                          : std::min(window_begin + radius + 1, end);
    const int enter_until = std::clamp(row_.input_end - radius, begin, end);
    leaving_ = cell(leave_from - radius - 1);
    if (row_.continues) {
      entering_ = cell(window_end);
    } else {
      entering_ = cell(window_begin);
      stretch<true, false, false>(window_end - window_begin);
    }
    // Four branch-free stretches: growing windows at the left image border (in a strip inside the
    // image: its first column), windows wider than the image, full windows, and shrinking windows
    // at the right border.
    stretch<true, false, true>(std::min(leave_from, enter_until) - begin);
    stretch<false, false, true>(leave_from - std::min(leave_from, enter_until));
    stretch<true, true, true>(enter_until - std::min(leave_from, enter_until));
    stretch<false, true, true>(end - std::max(leave_from, enter_until));
    if (row_.window_sums != nullptr) {
      for (int v = 0; v < kVectors; ++v) {
        hn::StoreU(sum_[v], Tag32(), row_.window_sums + first_lane_ + v * kStep);
      }
    }
  }

 private:
  static constexpr int kStep = static_cast<int>(hn::MaxLanes(Tag32()));

  [[nodiscard]] HWY_INLINE const std::int32_t* cell(int column) const {
    return row_.input + first_lane_ +
           static_cast<std::ptrdiff_t>(column - row_.input_begin) * lanes_;
  }

  template <bool kEnter, bool kLeave, bool kDeliver>
  HWY_INLINE void stretch(int columns) {
    const Tag32 d32;
    const std::ptrdiff_t lanes = lanes_;
    const std::int32_t* entering = entering_;
    const std::int32_t* leaving = leaving_;
    std::int32_t* output = output_;
    std::int32_t* minima = minima_;
    Vec32 sum[kVectors];
    for (int v = 0; v < kVectors; ++v) {
      sum[v] = sum_[v];
    }
    for (int column = 0; column < columns; ++column) {
      Vec32 min = hn::Zero(d32);
#pragma GCC unroll 4
      for (int v = 0; v < kVectors; ++v) {
        if constexpr (kEnter) {
          sum[v] = hn::Add(sum[v], hn::LoadU(d32, entering + v * kStep));
        }
        if constexpr (kLeave) {
          sum[v] = hn::Sub(sum[v], hn::LoadU(d32, leaving + v * kStep));
        }
        if constexpr (kDeliver && kStore) {
          hn::StoreU(sum[v], d32, output + v * kStep);
        }
        if constexpr (kDeliver && kMinima != Minima::kNone) {
          const Vec32 cells = kPadded ? hn::Max(sum[v], floor_[v]) : sum[v];
          min = v == 0 ? cells : hn::Min(min, cells);
        }
      }
      entering += kEnter ? lanes : 0;
      leaving += kLeave ? lanes : 0;
      output += kDeliver && kStore ? lanes : 0;
      if constexpr (kDeliver && kMinima != Minima::kNone) {
        if constexpr (kMinima == Minima::kContinue) {
          min = hn::Min(min, hn::LoadU(d32, minima));
        }
        hn::StoreU(min, d32, minima);
        minima += kLaneMultiple;
      }
    }
    for (int v = 0; v < kVectors; ++v) {
      sum_[v] = sum[v];
    }
    entering_ = entering;
    leaving_ = leaving;
    output_ = output;
    minima_ = minima;
  }

  const RowSum& row_;
  const int first_lane_;
  const std::ptrdiff_t lanes_;
  const std::int32_t* entering_ = nullptr;
  const std::int32_t* leaving_ = nullptr;
  std::int32_t* output_;
  std::int32_t* minima_;
  Vec32 sum_[kVectors];
  Vec32 floor_[kVectors];
};

template <int kVectors, bool kStore, Minima kMinima>
HWY_INLINE void lane_block(const RowSum& row, int lane) {
  const int end = lane + kVectors * static_cast<int>(hn::Lanes(Tag32()));
  if (kMinima == Minima::kNone || end <= row.candidates) {
    LaneBlock<kVectors, kStore, kMinima, false>(row, lane).run();
  } else {
    LaneBlock<kVectors, kStore, kMinima, true>(row, lane).run();
  }
}

template <bool kStore, bool kMinima>
HWY_INLINE void all_lanes(const RowSum& row) {
  constexpr Minima begin = kMinima ? Minima::kBegin : Minima::kNone;
  constexpr Minima go_on = kMinima ? Minima::kContinue : Minima::kNone;
  const int step = static_cast<int>(hn::Lanes(Tag32()));
  int lane = 0;
  if (row.lanes >= 4 * step) {
    lane_block<4, kStore, begin>(row, 0);
    for (lane = 4 * step; lane + 4 * step <= row.lanes; lane += 4 * step) {
      lane_block<4, kStore, go_on>(row, lane);
    }
  } else {
    lane_block<1, kStore, begin>(row, 0);
    lane = step;
  }
  for (; lane < row.lanes; lane += step) {
    lane_block<1, kStore, go_on>(row, lane);
  }
}

void row_sum_simd(const RowSum& row) {
  if (row.output_end <= row.output_begin) {
    return;
  }
  if (row.minima == nullptr) {
    all_lanes<true, false>(row);
    return;
  }
  if (row.output != nullptr) {
    all_lanes<true, true>(row);
  } else {
    all_lanes<false, true>(row);
  }
  reduce_minima(row.minima_work, row.output_end - row.output_begin, row.minima);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(row_sum_simd);

void row_sum(const RowSum& row) { HWY_DYNAMIC_DISPATCH(row_sum_simd)(row); }

}  // namespace vantage::kernels
#endif
