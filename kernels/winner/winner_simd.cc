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

// The same for cells that carry their index: the least cell is the first of the least sums.
HWY_INLINE Least indexed_least_of(const std::int32_t* cells, CandidateRange range, int index_bits) {
  const Tag32 d32;
  const int step = static_cast<int>(hn::Lanes(d32));
  const Vec32 worst = hn::Set(d32, std::numeric_limits<std::int32_t>::max());
  int i = range.begin / step * step;
  const Vec32 number = hn::Iota(d32, i);
  Vec32 least =
      hn::IfThenElse(hn::Lt(number, hn::Set(d32, range.begin)), worst, hn::LoadU(d32, cells + i));
  if (i + step > range.end) {
    least = hn::IfThenElse(hn::Gt(number, hn::Set(d32, range.end - 1)), worst, least);
  }
  for (i += step; i + step <= range.end; i += step) {
    least = hn::Min(least, hn::LoadU(d32, cells + i));
  }
  if (i < range.end) {
    const auto past_end = hn::Gt(hn::Iota(d32, i), hn::Set(d32, range.end - 1));
    least = hn::Min(least, hn::IfThenElse(past_end, worst, hn::LoadU(d32, cells + i)));
  }
  const std::int32_t cell = hn::GetLane(hn::MinOfLanes(d32, least));
  return {cell, cell & ((1 << index_bits) - 1)};
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
  const Least least =
      row.index_bits > 0 ? indexed_least_of(cells, full, row.index_bits) : least_of(cells, full);
  best.offer(least.index, row.sum(least.value), full_columns);
  for (int i = full.end; i < candidates.end; ++i) {
    best.offer(i, row.sum(cells[i]), full_columns - (i - full.end + 1));
  }
  return best.index();
}

// Lane by lane minimum over the candidates of a column; `padding` masks the lanes behind the last
// candidate of the last vector.
template <class Mask>
HWY_INLINE Vec32 lane_minima(const std::int32_t* cells, int count, Mask padding) {
  const Tag32 d32;
  const int step = static_cast<int>(hn::Lanes(d32));
  Vec32 least = hn::Set(d32, std::numeric_limits<std::int32_t>::max());
  int i = 0;
  for (; i + step <= count; i += step) {
    least = hn::Min(least, hn::LoadU(d32, cells + i));
  }
  if (i < count) {
    least = hn::Min(least, hn::IfThenElse(padding, least, hn::LoadU(d32, cells + i)));
  }
  return least;
}

// Cells that carry their index: the least cell names the winner. One vector of columns at a time,
// whose lane minima are reduced together as in a transposition.
HWY_INLINE void indexed_winners(const WinnerRow& row, const std::int32_t* cells, int columns,
                                std::int32_t* HWY_RESTRICT winners) {
  const Tag32 d32;
  const int step = static_cast<int>(hn::Lanes(d32));
  const int count = row.geometry.count;
  const std::size_t lanes = static_cast<std::size_t>(row.geometry.lanes());
  const auto padding_lanes = hn::Gt(hn::Iota(d32, 0), hn::Set(d32, count % step - 1));
  const Vec32 index_mask = hn::Set(d32, (1 << row.index_bits) - 1);
  HWY_ALIGN std::int32_t least[hn::MaxLanes(d32) * hn::MaxLanes(d32)];

  int j = 0;
  for (; j + step <= columns; j += step) {
    for (int column = 0; column < step; ++column, cells += lanes) {
      hn::Store(lane_minima(cells, count, padding_lanes), d32, least + column * step);
    }
#if HWY_TARGET != HWY_SCALAR
    // Each round halves the vectors: neighbouring lanes of two vectors are merged into one.
    for (int vectors = step / 2; vectors > 0; vectors /= 2) {
      for (int v = 0; v < vectors; ++v) {
        const Vec32 low = hn::Load(d32, least + 2 * v * step);
        const Vec32 high = hn::Load(d32, least + (2 * v + 1) * step);
        hn::Store(hn::Min(hn::ConcatEven(d32, high, low), hn::ConcatOdd(d32, high, low)), d32,
                  least + v * step);
      }
    }
#endif
    hn::StoreU(hn::And(hn::Load(d32, least), index_mask), d32, winners + j);
  }
  for (; j < columns; ++j, cells += lanes) {
    const Vec32 minimum = hn::MinOfLanes(d32, lane_minima(cells, count, padding_lanes));
    winners[j] = hn::GetLane(hn::And(minimum, index_mask));
  }
}

void select_winners_row_simd(const WinnerRow& row, std::int32_t* HWY_RESTRICT winners) {
  const std::size_t lanes = static_cast<std::size_t>(row.geometry.lanes());
  const auto [plain_begin, plain_end] = row.plain_columns();
  const auto cells_of = [&](int x) {
    return row.cells + static_cast<std::size_t>(x - row.first_column) * lanes;
  };
  for (int x = row.first_column; x < plain_begin; ++x) {
    winners[x - row.first_column] = border_winner(row, cells_of(x), x);
  }
  if (row.index_bits > 0) {
    indexed_winners(row, cells_of(plain_begin), plain_end - plain_begin,
                    winners + (plain_begin - row.first_column));
  } else {
    for (int x = plain_begin; x < plain_end; ++x) {
      winners[x - row.first_column] = least_of(cells_of(x), {0, row.geometry.count}).index;
    }
  }
  for (int x = plain_end; x < row.first_column + row.columns; ++x) {
    winners[x - row.first_column] = border_winner(row, cells_of(x), x);
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
