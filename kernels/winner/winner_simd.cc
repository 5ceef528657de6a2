#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/winner/winner_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include "kernels/winner/winner.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag32 = hn::ScalableTag<std::int32_t>;
using Vec32 = hn::VFromD<Tag32>;

struct Least {
  std::int32_t value = 0;
  std::int32_t index = kNoWinner;
};

// The smallest of cells[begin, end) and the first place it stands at; begin < end.
HWY_INLINE Least least_of(const std::int32_t* cells, CandidateRange range) {
  const Tag32 d32;
  const int step = static_cast<int>(hn::Lanes(d32));
  const Vec32 worst = hn::Set(d32, std::numeric_limits<std::int32_t>::max());
  const Vec32 steps = hn::Set(d32, step);

  // The vector in which the range begins has lanes before it, the one in which it ends lanes
  // behind it: both are masked. Vectors in between are not.
  int i = range.begin / step * step;
  Vec32 number = hn::Add(hn::Set(d32, i), hn::Iota(d32, 0));
  const auto before = hn::Lt(number, hn::Set(d32, range.begin));
  const auto behind = hn::Gt(number, hn::Set(d32, range.end - 1));
  Vec32 value = hn::IfThenElse(hn::Or(before, behind), worst, hn::LoadU(d32, cells + i));
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
  const Vec32 least = hn::MinOfLanes(d32, value);
  const Vec32 places = hn::IfThenElse(hn::Eq(value, least), index, worst);
  return {hn::GetLane(least), hn::GetLane(hn::MinOfLanes(d32, places))};
}

// Compares fractions sum/count in order of increasing candidates.
class BestFraction {
 public:
  HWY_INLINE void offer(std::int32_t index, std::int64_t sum, std::int64_t count) {
    if (index_ == kNoWinner || sum * count_ < sum_ * count) {
      index_ = index;
      sum_ = sum;
      count_ = count;
    }
  }
  [[nodiscard]] std::int32_t index() const { return index_; }

 private:
  std::int32_t index_ = kNoWinner;
  std::int64_t sum_ = 0;
  std::int64_t count_ = 1;
};

// A column near a border of the image, where candidates lack partners or part of their windows.
HWY_INLINE std::int32_t border_winner(const WinnerRow& row, const std::int32_t* cells, int x) {
  const CandidateRange candidates = row.candidates(x);
  if (candidates.empty()) {
    return kNoWinner;
  }
  BestFraction best;
  const CandidateRange full = row.full_window_candidates(x);
  if (full.empty()) {
    for (int i = candidates.begin; i < candidates.end; ++i) {
      best.offer(i, row.sum(cells[i]), row.window_columns(x, i));
    }
    return best.index();
  }
  // Outwards from the full windows each candidate loses one more column.
  const int full_columns = row.full_window_columns(x);
  for (int i = candidates.begin; i < full.begin; ++i) {
    best.offer(i, row.sum(cells[i]), full_columns - (full.begin - i));
  }
  const Least least = least_of(cells, full);
  best.offer(least.index, row.sum(least.value), full_columns);
  for (int i = full.end; i < candidates.end; ++i) {
    best.offer(i, row.sum(cells[i]), full_columns - (i - full.end + 1));
  }
  return best.index();
}

void plain_sum_winners(const WinnerRow& row, std::int32_t* HWY_RESTRICT winners) {
  const std::size_t lanes = static_cast<std::size_t>(row.geometry.lanes());
  const CandidateRange plain = row.plain_columns();
  const std::int32_t* cells = row.cells;
  for (int j = 0; j < row.columns; ++j, cells += lanes) {
    const int x = row.first_column + j;
    winners[j] = x >= plain.begin && x < plain.end ? least_of(cells, {0, row.geometry.count}).index
                                                   : border_winner(row, cells, x);
  }
}

// Winners of cells that carry their index: the least cell names the winner. One vector of columns
// at a time, whose lane-by-lane minima are reduced together as in a transposition.
class IndexedWinners {
 public:
  HWY_INLINE explicit IndexedWinners(const WinnerRow& row)
      : row_(row),
        lanes_(static_cast<std::size_t>(row.geometry.lanes())),
        plain_(row.plain_columns()) {}

  HWY_INLINE void run(std::int32_t* HWY_RESTRICT winners) const {
    const Tag32 d32;
    const int step = static_cast<int>(hn::Lanes(d32));
    HWY_ALIGN std::int32_t least[hn::MaxLanes(d32) * hn::MaxLanes(d32)] = {};
    for (int j = 0; j < row_.columns; j += step) {
      const int columns = std::min(step, row_.columns - j);
      for (int k = 0; k < columns; ++k) {
        hn::Store(lane_minima(j + k), d32, least + k * step);
      }
      reduce(least);
      if (columns == step) {
        hn::StoreU(index_of(hn::Load(d32, least)), d32, winners + j);
      } else {
        for (int k = 0; k < columns; ++k) {
          winners[j + k] = least[k] & index_mask();
        }
      }
      if (!is_plain(row_.first_column + j) || !is_plain(row_.first_column + j + columns - 1)) {
        for (int k = 0; k < columns; ++k) {
          finish(j + k, least[k], winners[j + k]);
        }
      }
    }
  }

 private:
  [[nodiscard]] HWY_INLINE bool is_plain(int x) const {
    return x >= plain_.begin && x < plain_.end;
  }
  [[nodiscard]] HWY_INLINE const std::int32_t* cells(int j) const {
    return row_.cells + static_cast<std::size_t>(j) * lanes_;
  }
  [[nodiscard]] HWY_INLINE std::int32_t index_mask() const { return (1 << row_.index_bits) - 1; }
  [[nodiscard]] HWY_INLINE Vec32 index_of(Vec32 cells) const {
    const Tag32 d32;
    return hn::And(cells, hn::Set(d32, index_mask()));
  }

  // How many candidates, from the first, have a whole window of partners at a column; 0 where
  // those do not start at the first candidate.
  [[nodiscard]] HWY_INLINE int leading_full(int x) const {
    if (is_plain(x)) {
      return row_.geometry.count;
    }
    const CandidateRange full = row_.full_window_candidates(x);
    return full.begin == 0 ? full.end : 0;
  }

  [[nodiscard]] HWY_INLINE Vec32 lane_minima(int j) const {
    const Tag32 d32;
    const int step = static_cast<int>(hn::Lanes(d32));
    const std::int32_t* column = cells(j);
    const int count = leading_full(row_.first_column + j);
    Vec32 least = hn::Set(d32, std::numeric_limits<std::int32_t>::max());
    int i = 0;
    for (; i + step <= count; i += step) {
      least = hn::Min(least, hn::LoadU(d32, column + i));
    }
    if (i < count) {
      const auto past_end = hn::Gt(hn::Iota(d32, i), hn::Set(d32, count - 1));
      least = hn::Min(least, hn::IfThenElse(past_end, least, hn::LoadU(d32, column + i)));
    }
    return least;
  }

  // Lane k of the first vector becomes the minimum of vector k. Each round halves the vectors:
  // neighbouring lanes of two of them are merged into one.
  static HWY_INLINE void reduce(std::int32_t* least) {
#if HWY_TARGET != HWY_SCALAR
    const Tag32 d32;
    const int step = static_cast<int>(hn::Lanes(d32));
    for (int vectors = step / 2; vectors > 0; vectors /= 2) {
      for (int v = 0; v < vectors; ++v) {
        const Vec32 low = hn::Load(d32, least + 2 * v * step);
        const Vec32 high = hn::Load(d32, least + (2 * v + 1) * step);
        hn::Store(hn::Min(hn::ConcatEven(d32, high, low), hn::ConcatOdd(d32, high, low)), d32,
                  least + v * step);
      }
    }
#else
    (void)least;
#endif
  }

  // Lets the candidates with shortened windows compete where there are any.
  HWY_INLINE void finish(int j, std::int32_t least, std::int32_t& winner) const {
    const int x = row_.first_column + j;
    if (is_plain(x)) {
      return;
    }
    const int full_end = leading_full(x);
    if (full_end == 0) {
      winner = border_winner(row_, cells(j), x);
      return;
    }
    const int full_columns = row_.full_window_columns(x);
    BestFraction best;
    best.offer(winner, row_.sum(least), full_columns);
    const std::int32_t* column = cells(j);
    for (int i = full_end, end = row_.candidates(x).end; i < end; ++i) {
      best.offer(i, row_.sum(column[i]), full_columns - (i - full_end + 1));
    }
    winner = best.index();
  }

  const WinnerRow& row_;
  std::size_t lanes_;
  CandidateRange plain_;
};

void select_winners_row_simd(const WinnerRow& row, std::int32_t* HWY_RESTRICT winners) {
  if (row.index_bits > 0) {
    IndexedWinners(row).run(winners);
  } else {
    plain_sum_winners(row, winners);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(select_winners_row_simd);

void select_winners_row(const WinnerRow& row, std::int32_t* winners) {
  HWY_DYNAMIC_DISPATCH(select_winners_row_simd)(row, winners);
}

}  // namespace vantage::kernels
#endif
