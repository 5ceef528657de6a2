#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/cells/byte_cells-inl.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "kernels/compact_likelihoods/reduced_sums-inl.h"
#include "kernels/pair_reduction/pair_reduction.h"

#ifndef VANTAGE_KERNELS_SHEARED_ROWS
#define VANTAGE_KERNELS_SHEARED_ROWS
namespace vantage::kernels {
namespace {

// Blocks of the right image that are made at a time: what is sheared for them fits level 1.
constexpr int kPartBlocks = 64;
constexpr int kShearedVectors = kPartBlocks + 32;

// Rounded down.
int half_of(int number) { return number >= 0 ? number / 2 : -((1 - number) / 2); }

// Sums of the left image's energies over pairs of columns are kept for blocks [begin, end), whose
// columns the image need not have. Block X of the right image is found at X + ⌊d/2⌋: for even
// disparities d in the sums over columns 2b and 2b + 1, for odd ones in those over 2b + 1 and
// 2b + 2.
struct SumBlocks {
  int begin;
  int end;
  [[nodiscard]] int size() const { return end - begin; }
};
SumBlocks sum_blocks(int columns, int lanes, int disparity_min) {
  const int blocks = (columns + 1) / 2;
  return {std::min(-1, half_of(disparity_min)),
          blocks + std::max(0, half_of(disparity_min + lanes - 1)) + 1};
}

}  // namespace
}  // namespace vantage::kernels
#endif

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// 16-bit numbers of the even and of the odd lanes of a vector of bytes.
template <class D8>
struct EvenOdd {
  VecOf<Tag16<D8> > even;
  VecOf<Tag16<D8> > odd;
};

template <class D8>
HWY_INLINE EvenOdd<D8> sum(const EvenOdd<D8>& a, const EvenOdd<D8>& b) {
  return {hn::Add(a.even, b.even), hn::Add(a.odd, b.odd)};
}

template <class D8>
HWY_INLINE EvenOdd<D8> widened(D8 d, const std::uint8_t* bytes) {
  const Tag16<D8> d16;
  const auto words = hn::BitCast(d16, hn::LoadU(d, bytes));
  return {hn::And(words, hn::Set(d16, 0xFF)), hn::ShiftRight<8>(words)};
}

// a in lanes whose number has bit kBit, else b.
template <int kBit, class D16>
HWY_INLINE VecOf<D16> by_bit(D16 d, VecOf<D16> a, VecOf<D16> b) {
  if constexpr (kBit == 1) {
    return hn::OddEven(a, b);
  } else if constexpr (kBit == 2) {
    const hn::Repartition<std::uint32_t, D16> d32;
    return hn::BitCast(d, hn::OddEven(hn::BitCast(d32, a), hn::BitCast(d32, b)));
  } else if constexpr (kBit == 4) {
    const hn::Repartition<std::uint64_t, D16> d64;
    return hn::BitCast(d, hn::OddEven(hn::BitCast(d64, a), hn::BitCast(d64, b)));
  } else if constexpr (kBit == 8) {
    return hn::OddEvenBlocks(a, b);
  } else {
    return hn::ConcatUpperLower(d, a, b);
  }
}

// to[x] = lane p of from[x + p], by the bits kBit and 2 · kBit of p, for x < count.
template <int kBit, class D16>
HWY_INLINE void shear_two_bits(D16 d, const std::uint16_t* from, int count, std::uint16_t* to) {
  constexpr std::size_t kLanes = hn::MaxLanes(D16());
  for (int x = 0; x < count; ++x, from += kLanes, to += kLanes) {
    const auto at = [&](std::size_t shift)
                        HWY_ATTR { return hn::LoadU(d, from + shift * kBit * kLanes); };
    const auto lower = by_bit<kBit>(d, at(1), at(0));
    const auto upper = by_bit<kBit>(d, at(3), at(2));
    hn::StoreU(by_bit<2 * kBit>(d, upper, lower), d, to);
  }
}
template <int kBit, class D16>
HWY_INLINE void shear_one_bit(D16 d, std::uint16_t* vectors, int count) {
  constexpr std::size_t kLanes = hn::MaxLanes(D16());
  for (int x = 0; x < count; ++x, vectors += kLanes) {
    hn::StoreU(by_bit<kBit>(d, hn::LoadU(d, vectors + kBit * kLanes), hn::LoadU(d, vectors)), d,
               vectors);
  }
}

// Lane p of to[x] becomes that of from[x + p], for x < count ≤ kPartBlocks: bit by bit of p. `to`
// holds a vector more per lane.
template <class D16>
HWY_INLINE void shear(D16 d, const std::uint16_t* from, int count, std::uint16_t* to) {
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D16()));
  shear_two_bits<1>(d, from, count + kLanes - 4, to);
  if constexpr (kLanes == 8) {
    shear_one_bit<4>(d, to, count);
  } else if constexpr (kLanes == 16) {
    shear_two_bits<4>(d, to, count, to);
  } else {
    shear_two_bits<4>(d, to, count + 16, to);
    shear_one_bit<16>(d, to, count);
  }
}

// kOddFirst: candidate 0 is an odd disparity.
template <bool kOddFirst>
class PairReduction {
 public:
  explicit PairReduction(const PairRow& given)
      : row_(given),
        blocks_(sum_blocks(given.columns, given.lanes, given.disparity_min)),
        units_(static_cast<std::int16_t>(std::lround(given.weight * kCompactWeightUnits))),
        pair_sums_(given.work),
        column_sums_(given.work + std::ptrdiff_t{given.lanes} * blocks_.size()),
        last_column_(column_sums_ + given.lanes),
        sheared_(last_column_ + given.lanes),
        absent_(reinterpret_cast<std::uint8_t*>(sheared_ +
                                                std::ptrdiff_t{given.lanes} * kShearedVectors)) {}

  void start() const {
    std::fill_n(absent_, row_.count, row_.without_partner);
    std::fill(absent_ + row_.count, absent_ + row_.lanes, std::numeric_limits<std::uint8_t>::max());
    fill_absent(blocks_.begin, -1);
    fill_absent((row_.columns + 1) / 2, blocks_.end);
    // Block −1, whose second column is the first one of the image.
    each_lane_vector(row_.lanes, [&](auto d, int lane) HWY_ATTR {
      const auto rows = absent_rows(d, lane);
      store_pairs(d, lane, -1, sum(rows, rows), rows);
    });
  }

  // Columns of the left image, and the sums over pairs of columns.
  HWY_INLINE void reduce_left(const BlockRow<std::uint8_t>& part, int first_column,
                              std::uint8_t* energies) const {
    const std::uint8_t* const upper = part.upper;
    const std::uint8_t* const lower = part.lower;
    const int lanes = row_.lanes;
    const int first_block = first_column / 2;
    const bool is_last = first_column + part.columns == row_.columns;
    for (int b = 0; b < part.blocks(); ++b, energies += lanes) {
      const std::ptrdiff_t left = part.left(b);
      const std::ptrdiff_t right = part.right(b);
      const bool has_right = 2 * b + 1 < part.columns;
      const int block = first_block + b;
      auto min = hn::Set(SumTag(), std::numeric_limits<std::uint16_t>::max());
      each_lane_vector(lanes, [&](auto d, int lane) HWY_ATTR {
        const Tag16<decltype(d)> d16;
        const auto of_left = sum(widened(d, upper + left + lane), widened(d, lower + left + lane));
        const auto of_right =
            sum(widened(d, upper + right + lane), widened(d, lower + right + lane));
        const auto both = sum(of_left, of_right);
        hn::StoreU(both.even, d16, column_sums_ + lane);
        hn::StoreU(both.odd, d16, column_sums_ + lane + hn::Lanes(d16));
        min = hn::Min(min, fold_min(d16, hn::Min(both.even, both.odd)));
        const auto after = has_right ? of_right : absent_rows(d, lane);
        store_pairs(d, lane, block, sum(of_left, after), after);
        finish_odd_pairs(d, lane, block - 1, of_left);
      });
      weigh(min, energies);
    }
    if (is_last) {
      each_lane_vector(lanes, [&](auto d, int lane) HWY_ATTR {
        finish_odd_pairs(d, lane, first_block + part.blocks() - 1, absent_rows(d, lane));
      });
    }
    keep_last_column(part, first_column);
  }

  // The right image's columns, from those sums.
  HWY_INLINE void reduce_right(std::uint8_t* energies) const {
    const int blocks = (row_.columns + 1) / 2;
    const int lanes = row_.lanes;
    for (int first = 0; first < blocks; first += kPartBlocks) {
      const int count = std::min(kPartBlocks, blocks - first);
      each_lane_vector(lanes, [&](auto d, int lane) HWY_ATTR {
        const Tag16<decltype(d)> d16;
        for (const int odd_lanes : {0, 1}) {
          // Lanes are one block apart.
          shear(d16,
                sums_at(d, lane, odd_lanes, first + half_of(row_.disparity_min + lane + odd_lanes)),
                count, sheared(d, lane, odd_lanes));
        }
        if (row_.columns % 2 != 0 && first + count == blocks) {
          repeat_last_column(d, lane, count - 1);
        }
      });
      for (int b = 0; b < count; ++b, energies += lanes) {
        auto min = hn::Set(SumTag(), std::numeric_limits<std::uint16_t>::max());
        each_lane_vector(lanes, [&](auto d, int lane) HWY_ATTR {
          const Tag16<decltype(d)> d16;
          const std::ptrdiff_t at = b * static_cast<std::ptrdiff_t>(hn::Lanes(d16));
          const auto even = hn::LoadU(d16, sheared(d, lane, 0) + at);
          const auto odd = hn::LoadU(d16, sheared(d, lane, 1) + at);
          hn::StoreU(even, d16, column_sums_ + lane);
          hn::StoreU(odd, d16, column_sums_ + lane + hn::Lanes(d16));
          min = hn::Min(min, fold_min(d16, hn::Min(even, odd)));
        });
        weigh(min, energies);
      }
    }
  }

 private:
  // Sums of the even (0) or odd (1) lanes of a vector: those of one block after the other.
  template <class D8>
  [[nodiscard]] HWY_INLINE std::uint16_t* sums_at(D8 /*d*/, int lane, int odd_lanes,
                                                  int block) const {
    constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tag16<D8>()));
    return pair_sums_ + std::ptrdiff_t{lane + odd_lanes * kLanes} * blocks_.size() +
           std::ptrdiff_t{kLanes} * (block - blocks_.begin);
  }
  // Likewise, of the blocks of a part of the right image.
  template <class D8>
  [[nodiscard]] HWY_INLINE std::uint16_t* sheared(D8 /*d*/, int lane, int odd_lanes) const {
    constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tag16<D8>()));
    return sheared_ + std::ptrdiff_t{lane + odd_lanes * kLanes} * kShearedVectors;
  }

  // A column without a partner.
  template <class D8>
  [[nodiscard]] HWY_INLINE EvenOdd<D8> absent_rows(D8 d, int lane) const {
    const auto row = widened(d, absent_ + lane);
    return sum(row, row);
  }

  HWY_INLINE void fill_absent(int begin, int end) const {
    each_lane_vector(row_.lanes, [&](auto d, int lane) HWY_ATTR {
      const auto rows = absent_rows(d, lane);
      const auto both = sum(rows, rows);
      for (int b = begin; b < end; ++b) {
        store(d, lane, b, both.even, both.odd);
      }
    });
  }

  // Even disparities are finished; odd ones get their first column.
  template <class D8>
  HWY_INLINE void store_pairs(D8 d, int lane, int block, const EvenOdd<D8>& both,
                              const EvenOdd<D8>& second) const {
    store(d, lane, block, kOddFirst ? second.even : both.even, kOddFirst ? both.odd : second.odd);
  }
  template <class D8>
  HWY_INLINE void store(D8 d, int lane, int block, VecOf<Tag16<D8> > even,
                        VecOf<Tag16<D8> > odd) const {
    hn::StoreU(even, Tag16<D8>(), sums_at(d, lane, 0, block));
    hn::StoreU(odd, Tag16<D8>(), sums_at(d, lane, 1, block));
  }
  template <class D8>
  HWY_INLINE void finish_odd_pairs(D8 d, int lane, int block, const EvenOdd<D8>& column) const {
    const Tag16<D8> d16;
    std::uint16_t* const first = sums_at(d, lane, kOddFirst ? 0 : 1, block);
    hn::StoreU(hn::Add(hn::LoadU(d16, first), kOddFirst ? column.even : column.odd), d16, first);
  }

  // With an odd number of columns the right image's last block is its last column twice.
  // Disparities above 0 have no partner there, nor one column further, like all blocks after the
  // row.
  HWY_INLINE void keep_last_column(const BlockRow<std::uint8_t>& part, int first_column) const {
    const int first = std::max(row_.disparity_min, first_column - (row_.columns - 1));
    const int end = std::min(
        {row_.disparity_min + row_.count, 1, first_column + part.columns - (row_.columns - 1)});
    for (int disparity = first; disparity < end; ++disparity) {
      const int candidate = disparity - row_.disparity_min;
      const std::ptrdiff_t cell =
          std::ptrdiff_t{row_.columns - 1 + disparity - first_column} * row_.lanes + candidate;
      last_column_[candidate] =
          static_cast<std::uint16_t>(2 * (part.upper[cell] + part.lower[cell]));
    }
  }
  template <class D8>
  HWY_INLINE void repeat_last_column(D8 d, int lane, int block) const {
    constexpr int kLanes = static_cast<int>(hn::MaxLanes(D8()));
    const int end = std::min({lane + kLanes, row_.count, 1 - row_.disparity_min});
    for (int candidate = lane; candidate < end; ++candidate) {
      const int in_vector = candidate - lane;
      sheared(d, lane, in_vector % 2)[block * (kLanes / 2) + in_vector / 2] =
          last_column_[candidate];
    }
  }

  HWY_INLINE void weigh(VecOf<SumTag> min, std::uint8_t* energies) const {
    weigh_sums(column_sums_, row_.lanes, hn::GetLane(hn::MinOfLanes(SumTag(), min)), units_,
               energies);
  }

  const PairRow row_;
  SumBlocks blocks_;
  std::int16_t units_;
  std::uint16_t* pair_sums_;
  std::uint16_t* column_sums_;  // of one block
  std::uint16_t* last_column_;  // of the right image, by candidate
  std::uint16_t* sheared_;
  std::uint8_t* absent_;  // a column without partners
};

// Calls body with the reduction of a row.
template <class Body>
HWY_INLINE void with_reduction(const PairRow& row, const Body& body) {
  if (row.disparity_min % 2 != 0) {
    body(PairReduction<true>(row));
  } else {
    body(PairReduction<false>(row));
  }
}

void start(const PairRow& row) {
  with_reduction(row, [](const auto& reduction) HWY_ATTR { reduction.start(); });
}
void left_part(const PairRow& row, const BlockRow<std::uint8_t>& part, int first_column,
               std::uint8_t* energies) {
  with_reduction(row, [&](const auto& reduction)
                          HWY_ATTR { reduction.reduce_left(part, first_column, energies); });
}
void right_row(const PairRow& row, std::uint8_t* energies) {
  with_reduction(row, [&](const auto& reduction) HWY_ATTR { reduction.reduce_right(energies); });
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(start);
HWY_EXPORT(left_part);
HWY_EXPORT(right_row);

std::size_t pair_row_work(int columns, int lanes, int disparity_min) {
  // The sums of all blocks; of one block; the last column; what is sheared; a column of bytes.
  return static_cast<std::size_t>(lanes) *
         static_cast<std::size_t>(sum_blocks(columns, lanes, disparity_min).size() + 1 + 1 +
                                  kShearedVectors + 1);
}

void start_pair_row(const PairRow& row) { HWY_DYNAMIC_DISPATCH(start)(row); }
void reduce_left_part(const PairRow& row, const BlockRow<std::uint8_t>& part, int first_column,
                      std::uint8_t* energies) {
  HWY_DYNAMIC_DISPATCH(left_part)(row, part, first_column, energies);
}
void reduce_right_row(const PairRow& row, std::uint8_t* energies) {
  HWY_DYNAMIC_DISPATCH(right_row)(row, energies);
}

}  // namespace vantage::kernels
#endif
