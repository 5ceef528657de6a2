#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "kernels/winner/lane_minima-inl.h"
#include "kernels/winner/winner.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag32 = hn::ScalableTag<std::int32_t>;
using Vec32 = hn::VFromD<Tag32>;

struct Least {
  std::int32_t value = 0;
  std::int32_t index = kNoWinner;
};

// Minimum of cells[begin, end) and its first position; begin < end.
HWY_INLINE Least min_of(const std::int32_t* cells, CandidateRange range) {
  const Tag32 d32;
  const int step = static_cast<int>(hn::Lanes(d32));
  const Vec32 worst = hn::Set(d32, std::numeric_limits<std::int32_t>::max());
  const Vec32 steps = hn::Set(d32, step);

  // The first vector may have lanes before the range, the last one lanes after it; both are masked.
  // Vectors in between are not.
  int i = range.begin / step * step;
  Vec32 number = hn::Add(hn::Set(d32, i), hn::Iota(d32, 0));
  const auto before = hn::Lt(number, hn::Set(d32, range.begin));
  const auto after = hn::Gt(number, hn::Set(d32, range.end - 1));
  Vec32 value = hn::IfThenElse(hn::Or(before, after), worst, hn::LoadU(d32, cells + i));
  Vec32 index = number;
  i += step;
  for (; i + step <= range.end; i += step) {
    number = hn::Add(number, steps);
    const Vec32 next = hn::LoadU(d32, cells + i);
    index = hn::IfThenElse(hn::Lt(next, value), number, index);
    value = hn::Min(value, next);
  }
  if (i < range.end) {
    number = hn::Add(number, steps);
    const auto past_end = hn::Gt(number, hn::Set(d32, range.end - 1));
    const Vec32 next = hn::IfThenElse(past_end, worst, hn::LoadU(d32, cells + i));
    index = hn::IfThenElse(hn::Lt(next, value), number, index);
    value = hn::Min(value, next);
  }
  const Vec32 min = hn::MinOfLanes(d32, value);
  const Vec32 places = hn::IfThenElse(hn::Eq(value, min), index, worst);
  return {hn::GetLane(min), hn::GetLane(hn::MinOfLanes(d32, places))};
}

// Compares fractions sum/count in order of increasing candidates. Branch-free: near a border the
// winning candidate is as good as random.
class BestFraction {
 public:
  HWY_INLINE BestFraction(std::int32_t index, std::int64_t sum, std::int64_t count)
      : index_(index), sum_(sum), count_(count) {}
  HWY_INLINE void offer(std::int32_t index, std::int64_t sum, std::int64_t count) {
    const bool wins = sum * count_ < sum_ * count;
    index_ = wins ? index : index_;
    sum_ = wins ? sum : sum_;
    count_ = wins ? count : count_;
  }
  [[nodiscard]] std::int32_t index() const { return index_; }

 private:
  std::int32_t index_;
  std::int64_t sum_;
  std::int64_t count_;
};

// Any column, including columns near an image border, where candidates lack partners or parts of
// their windows.
std::int32_t winner_of(const WinnerRow& row, const std::int32_t* cells, int x) {
  const CandidateRange candidates = row.candidates(x);
  if (candidates.empty()) {
    return kNoWinner;
  }
  const CandidateRange full = row.full_window_candidates(x);
  const auto fraction = [&](int i) HWY_ATTR {
    return BestFraction(i, row.sum(cells[i]), row.window_columns(x, i));
  };
  BestFraction best = fraction(candidates.begin);
  const auto offer = [&](int begin, int end) HWY_ATTR {
    for (int i = begin; i < end; ++i) {
      best.offer(i, row.sum(cells[i]), row.window_columns(x, i));
    }
  };
  if (full.empty()) {
    offer(candidates.begin, candidates.end);
    return best.index();
  }
  offer(candidates.begin, full.begin);
  const Least min = min_of(cells, full);
  if (full == candidates) {
    return min.index;
  }
  best.offer(min.index, row.sum(min.value), row.full_window_columns(x));
  offer(full.end, candidates.end);
  return best.index();
}

// Offers the candidates of `range`. Each window has one column fewer than the previous one; the
// first has `columns` − 1. Compares quotients in double: sums below 2³¹ over fewer than 2⁹ columns
// are equal as doubles only if they are equal, so the order of the fractions is preserved.
HWY_INLINE void offer_shortened(const WinnerRow& row, const std::int32_t* cells,
                                CandidateRange range, int columns, BestFraction& best) {
  const hn::ScalableTag<double> d64;
  const hn::Rebind<std::int32_t, decltype(d64)> d32;
  const int step = static_cast<int>(hn::Lanes(d64));
  const auto none = hn::Set(d64, std::numeric_limits<double>::infinity());
  const auto lane = hn::Iota(d64, 0);
  auto min = none;
  auto place = hn::Zero(d64);
  int i = range.begin;
  for (; i + step <= range.end; i += step) {
    const auto sums =
        hn::PromoteTo(d64, hn::ShiftRightSame(hn::LoadU(d32, cells + i), row.index_bits));
    const auto counts = hn::Sub(hn::Set(d64, columns - 1 - (i - range.begin)), lane);
    const auto quotient = hn::Div(sums, counts);
    const auto wins = hn::Lt(quotient, min);
    min = hn::IfThenElse(wins, quotient, min);
    place = hn::IfThenElse(wins, hn::Add(hn::Set(d64, i), lane), place);
  }
  if (i > range.begin) {
    const auto is_min = hn::Eq(min, hn::MinOfLanes(d64, min));
    const auto first = hn::MinOfLanes(d64, hn::IfThenElse(is_min, place, none));
    const int index = static_cast<int>(hn::GetLane(first));
    best.offer(index, row.sum(cells[index]), columns - (index - range.begin + 1));
  }
  for (; i < range.end; ++i) {
    best.offer(i, row.sum(cells[i]), columns - (i - range.begin + 1));
  }
}

// Per lane, the candidate number of the first of `lanes` cells that equals `value`; a large number
// in lanes without a match. Does not stop early: the winner's position is as good as random, and a
// mispredicted branch costs more than all vectors.
HWY_INLINE Vec32 lane_places(const std::int32_t* cells, int lanes, std::int32_t value) {
  const Tag32 d32;
  const int step = static_cast<int>(hn::Lanes(d32));
  const Vec32 wanted = hn::Set(d32, value);
  Vec32 place = hn::Set(d32, 1 << 30);
  // From the last vector to the first, so that the first position remains.
  for (int i = lanes - step; i >= 0; i -= step) {
    const auto is_wanted = hn::Eq(hn::LoadU(d32, cells + i), wanted);
    place = hn::IfThenElse(is_wanted, hn::Set(d32, i), place);
  }
  return hn::Add(place, hn::Iota(d32, 0));
}

// Columns near an image border, one vector of columns at a time, so that their per-lane minima are
// reduced together.
class BorderWinners {
 public:
  HWY_INLINE explicit BorderWinners(const WinnerRow& row)
      : row_(row), lanes_(row.geometry.lanes()) {}

  HWY_INLINE void run(std::int32_t* HWY_RESTRICT winners) const {
    const Tag32 d32;
    const int step = static_cast<int>(hn::Lanes(d32));
    HWY_ALIGN std::int32_t per_lane[kMax * kLaneMultiple] = {};
    HWY_ALIGN std::int32_t min[kMax];
    HWY_ALIGN std::int32_t place[kMax];
    for (int j = 0; j < row_.columns; j += step) {
      const int columns = std::min(step, row_.columns - j);
      const Columns shape = shape_of(row_.first_column + j);
      for (int k = 0; k < columns; ++k) {
        hn::Store(lane_minima(cells(j + k), shape.full_end[k]), d32, per_lane + k * kLaneMultiple);
      }
      reduce_minima(per_lane, columns, min);
      if (row_.index_bits > 0) {
        for (int k = 0; k < columns; ++k) {
          place[k] = min[k] & ((1 << row_.index_bits) - 1);
        }
      } else {
        for (int k = 0; k < columns; ++k) {
          hn::Store(lane_places(cells(j + k), lanes_, min[k]), d32, per_lane + k * kLaneMultiple);
        }
        reduce_minima(per_lane, columns, place);
      }
      for (int k = 0; k < columns; ++k) {
        winners[j + k] = shape.full_end[k] == 0
                             ? winner_of(row_, cells(j + k), row_.first_column + j + k)
                             : winner(cells(j + k), min[k], place[k], shape.full_end[k],
                                      shape.candidates_end[k], shape.full_columns[k]);
      }
    }
  }

 private:
  static constexpr std::size_t kMax = hn::MaxLanes(Tag32());

  /// For a vector of columns: the number of leading candidates with a whole window of partners (0
  /// if those do not start at the first candidate), the number of candidates with a partner, and
  /// the number of columns of a whole window.
  struct Columns {
    int full_end[kMax];
    int candidates_end[kMax];
    int full_columns[kMax];
  };

  [[nodiscard]] HWY_INLINE const std::int32_t* cells(int j) const {
    return row_.cells + static_cast<std::ptrdiff_t>(j) * lanes_;
  }

  // CandidateGeometry::with_partners() for neighbouring columns, in a vectorisable form.
  [[nodiscard]] HWY_INLINE Columns shape_of(int first_x) const {
    const CandidateGeometry& geometry = row_.geometry;
    const int radius = row_.window_radius;
    const int last_column = geometry.width - 1;
    const bool left = geometry.direction < 0;
    const int min = geometry.disparity_min;
    const int count = geometry.count;
    const int steps = geometry.steps_per_px;
    const bool whole_only = row_.whole_windows_only;
    Columns shape;
    for (std::size_t k = 0; k < kMax; ++k) {
      const int x = std::min(first_x + static_cast<int>(k), last_column);
      const int begin = std::max(x - radius, 0);
      const int last = std::min(x + radius, last_column);
      // Columns of the other image in the direction of increasing and of decreasing disparities.
      const int room = left ? begin : last_column - last;
      const int room_after = left ? last_column - last : begin;
      const int full_end = std::clamp(steps * room - min + 1, 0, count);
      // Of candidates between pixels, several in a row have windows of the same size.
      const bool is_irregular = whole_only || !geometry.is_of_one() || steps * room_after < -min ||
                                (steps > 1 && full_end < count);
      shape.full_end[k] = is_irregular ? 0 : full_end;
      shape.candidates_end[k] =
          std::clamp(steps * (left ? x : last_column - x) - min + 1, 0, count);
      shape.full_columns[k] = last - begin + 1;
    }
    return shape;
  }

  // Per-lane minimum of the first `count` cells. All lanes are read: a loop whose length varies
  // between columns costs more in mispredicted branches.
  [[nodiscard]] HWY_INLINE Vec32 lane_minima(const std::int32_t* cells, int count) const {
    const Tag32 d32;
    const int step = static_cast<int>(hn::Lanes(d32));
    const Vec32 worst = hn::Set(d32, std::numeric_limits<std::int32_t>::max());
    const Vec32 end = hn::Set(d32, count);
    Vec32 min = worst;
    for (int i = 0; i < lanes_; i += step) {
      const auto is_candidate = hn::Lt(lane_numbers(i), end);
      min = hn::Min(min, hn::IfThenElse(is_candidate, hn::LoadU(d32, cells + i), worst));
    }
    return min;
  }

  // Best of the minimum over full windows and the candidates with shortened windows, each of which
  // loses one more column than the previous one.
  [[nodiscard]] HWY_INLINE std::int32_t winner(const std::int32_t* column, std::int32_t min,
                                               std::int32_t place, int full_end, int end,
                                               int full_columns) const {
    const std::int64_t min_sum = row_.sum(min);
    BestFraction best(place, min_sum, full_columns);
    if (end - full_end >= kManyCandidates) {
      offer_shortened(row_, column, {full_end, end}, full_columns, best);
      return best.index();
    }
    for (int i = full_end; i < end; ++i) {
      best.offer(i, row_.sum(column[i]), full_columns - (i - full_end + 1));
    }
    return best.index();
  }

  // From this many candidates, vectors of quotients are faster.
  static constexpr int kManyCandidates = 12;

  const WinnerRow& row_;
  int lanes_;
};

void select_winners_row_simd(const WinnerRow& row, std::int32_t* HWY_RESTRICT winners) {
  BorderWinners(row).run(winners);
}

void locate_minima_row_simd(const std::int32_t* cells, const std::int32_t* minima, int lanes,
                            int columns, std::int32_t* HWY_RESTRICT winners) {
  const Tag32 d32;
  const int step = static_cast<int>(hn::Lanes(d32));
  HWY_ALIGN std::int32_t per_lane[hn::MaxLanes(d32) * kLaneMultiple] = {};
  for (int j = 0; j < columns; j += step) {
    const int count = std::min(step, columns - j);
    for (int k = 0; k < count; ++k, cells += lanes) {
      hn::Store(lane_places(cells, lanes, minima[j + k]), d32, per_lane + k * kLaneMultiple);
    }
    reduce_minima(per_lane, count, winners + j);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(select_winners_row_simd);
HWY_EXPORT(locate_minima_row_simd);

void select_winners_row(const WinnerRow& row, std::int32_t* winners) {
  HWY_DYNAMIC_DISPATCH(select_winners_row_simd)(row, winners);
}

void locate_minima_row(const std::int32_t* cells, const std::int32_t* minima, int lanes,
                       int columns, std::int32_t* winners) {
  HWY_DYNAMIC_DISPATCH(locate_minima_row_simd)(cells, minima, lanes, columns, winners);
}

}  // namespace vantage::kernels
#endif
