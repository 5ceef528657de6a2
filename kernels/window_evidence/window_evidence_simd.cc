#include "kernels/simd-inl.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "kernels/cells/byte_cells-inl.h"
#include "kernels/ray_census/ray_census-inl.h"
#include "kernels/window_evidence/window_evidence.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// With columns of 2×2 pixels a block of 16 bytes holds eight candidates of the left pixel of a
// column's row, and of the right one. A vector holds such blocks of, as far as they fit, the two
// columns of a pair, then both rows.
using TagBlocks = hn::CappedTag<std::uint8_t, 64>;
using TagBlock = hn::CappedTag<std::uint8_t, 16>;
using VecBlocks = hn::VFromD<TagBlocks>;
using VecBlock = hn::VFromD<TagBlock>;
constexpr std::size_t kBlocks = hn::MaxLanes(TagBlocks()) / 16;
constexpr std::size_t kVectorColumns = kBlocks == 1 ? 1 : 2;
constexpr std::size_t kVectorRows = kBlocks / kVectorColumns;
constexpr int kPair = 2;

// Lookups within blocks, for the columns of a pair.
struct Places {
  alignas(64) std::uint8_t of_own[64];     // a pixel's byte, of four bytes, to its half
  alignas(64) std::uint8_t forwards[64];   // partners at and after the byte of the left pixel
  alignas(64) std::uint8_t backwards[64];  // partners at and before it
};
constexpr Places places() {
  Places places{};
  for (int i = 0; i < 64; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int pixel = i / 16 % kPair * 2 + i % 16 / 8;
    places.of_own[at] = static_cast<std::uint8_t>(pixel);
    places.forwards[at] = static_cast<std::uint8_t>(i % 8 + pixel);
    places.backwards[at] = static_cast<std::uint8_t>(7 - i % 8 + pixel);
  }
  return places;
}
constexpr Places kPlaces = places();

// The same for columns of one pixel: a block is a pair.
constexpr Places pair_places() {
  Places places{};
  for (int i = 0; i < 64; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const int right = i % 16 / 8;
    places.of_own[at] = static_cast<std::uint8_t>(i / 16 * kPair + right);
    places.forwards[at] = static_cast<std::uint8_t>(i % 8 + right);
    places.backwards[at] = static_cast<std::uint8_t>(7 - i % 8 + right);
  }
  return places;
}
constexpr Places kPairPlaces = pair_places();

// One vector of the same block for each column; row(r) makes those of a row.
template <class Row>
HWY_INLINE VecBlocks rows_of(std::size_t first_row, const Row& row) {
  if constexpr (kVectorRows == 1) {
    return row(first_row);
  } else {
    (void)first_row;
    return hn::Combine(TagBlocks(), row(std::size_t{1}), row(std::size_t{0}));
  }
}

// The sum of the blocks of one of a vector's columns.
template <std::size_t kColumn, class D>
HWY_INLINE VecBlock sum_of_blocks(D /*d*/, hn::VFromD<D> blocks) {
  if constexpr (hn::MaxLanes(D()) == 16) {
    return blocks;
  } else {
    const hn::Half<D> half;
    if constexpr (hn::MaxLanes(D()) == 64) {
      return sum_of_blocks<kColumn>(
          half, hn::Add(hn::LowerHalf(half, blocks), hn::UpperHalf(half, blocks)));
    } else if constexpr (kColumn == 0) {
      return hn::LowerHalf(half, blocks);
    } else {
      return hn::UpperHalf(half, blocks);
    }
  }
}

// Columns of 2×2 pixels.
template <int kThresholds, int kEntries>
class SquareWindows {
 public:
  SquareWindows(const WindowEvidenceRow& row, const ByteByDistance& by_distance)
      : direction_(row.direction),
        before_(row.direction < 0 ? kWindowCandidates - 1 : 0),
        by_distance_(by_distance) {
    for (std::size_t p = 0; p < ray_census_bytes(kThresholds); ++p) {
      for (std::size_t r = 0; r < 2; ++r) {
        reference_[p][r] = row.reference[r][p];
        partner_[p][r] = row.partner[r][p];
      }
    }
  }

  // Evidence of columns x and x + 1, whose windows begin at `start`. kColumns: 1 if the second one
  // does not exist.
  template <int kColumns>
  HWY_INLINE void write(int x, int start, WindowCells* evidence) const {
    const TagBlock block;
    const hn::Repartition<std::uint64_t, TagBlock> d64;
    const std::ptrdiff_t pixel = std::ptrdiff_t{2} * x;
    const std::ptrdiff_t first = pixel + direction_ * start - before_;
    const auto sum = [&](std::size_t column) HWY_ATTR {
      const VecBlocks of_first = of_rows<kColumns>(column, 0, pixel, first);
      return kVectorRows == 2 ? of_first
                              : hn::Add(of_first, of_rows<kColumns>(column, 1, pixel, first));
    };
    const VecBlocks sums = sum(0);
    const VecBlock left = sum_of_blocks<0>(TagBlocks(), sums);
    const VecBlock right = sum_of_blocks<1>(TagBlocks(), kVectorColumns == 2 ? sums : sum(1));
    const auto of_left = hn::BitCast(d64, left);
    const auto of_right = hn::BitCast(d64, right);
    const auto cells =
        hn::BitCast(d64, hn::Add(hn::BitCast(block, hn::InterleaveLower(d64, of_left, of_right)),
                                 hn::BitCast(block, hn::InterleaveUpper(d64, of_left, of_right))));
    if constexpr (kColumns == 1) {
      *evidence = hn::GetLane(cells);
    } else {
      hn::StoreU(cells, d64, evidence);
    }
  }

 private:
  // The evidence of the pixels of a vector's columns and rows.
  template <int kColumns>
  [[nodiscard]] HWY_INLINE VecBlocks of_rows(std::size_t column, std::size_t first_row,
                                             std::ptrdiff_t pixel, std::ptrdiff_t first) const {
    const TagBlocks d;
    const hn::CappedTag<std::uint8_t, 16 * kVectorColumns> columns;
    const hn::Repartition<std::uint32_t, decltype(columns)> words;
    const VecBlocks places =
        hn::Load(d, (direction_ < 0 ? kPlaces.backwards : kPlaces.forwards) + 16 * column);
    const VecBlocks own_places = hn::Load(d, kPlaces.of_own + 16 * column);
    CodeDistance<kThresholds, TagBlocks> distance(d);
    distance.add(
        d,
        [&](std::size_t p) HWY_ATTR {
          return hn::TableLookupBytes(rows_of(first_row,
                                              [&](std::size_t r) HWY_ATTR {
                                                std::uint32_t bytes = 0;
                                                std::memcpy(&bytes, reference_[p][r] + pixel,
                                                            std::size_t{2 * kColumns});
                                                return hn::BitCast(columns, hn::Set(words, bytes));
                                              }),
                                      own_places);
        },
        [&](std::size_t p) HWY_ATTR {
          return hn::TableLookupBytes(
              rows_of(first_row,
                      [&](std::size_t r)
                          HWY_ATTR { return hn::LoadDup128(columns, partner_[p][r] + first); }),
              places);
        });
    return looked_up_bytes<kEntries>(d, by_distance_, distance.value());
  }

  std::ptrdiff_t direction_;
  std::ptrdiff_t
      before_;  // bytes from the first one loaded to the left pixel's at the window's start
  ByteByDistance by_distance_;
  const std::uint8_t* reference_[ray_census_bytes(kThresholds)][2];
  const std::uint8_t* partner_[ray_census_bytes(kThresholds)][2];
};

template <int kThresholds, int kEntries>
HWY_INLINE void square_evidence(const WindowEvidenceRow& row, const ByteByDistance& by_distance,
                                const std::array<WindowCells*, kWindows>& evidence) {
  const SquareWindows<kThresholds, kEntries> windows(row, by_distance);
  const auto [first, second] = evidence;
  const auto [first_start, second_start] = row.start;
  const std::uint8_t* const has_second = row.has_second;
  const int columns = row.columns;
  int x = 0;
  for (; x + kPair <= columns; x += kPair) {
    windows.template write<kPair>(x, first_start[x], first + x);
    if (has_second[x] != 0) {
      windows.template write<kPair>(x, second_start[x], second + x);
    } else {
      second[x] = second[x + 1] = 0;
    }
  }
  if (x < columns) {
    windows.template write<1>(x, first_start[x], first + x);
    second[x] = 0;
    if (has_second[x] != 0) {
      windows.template write<1>(x, second_start[x], second + x);
    }
  }
}

// Columns of one pixel. A block holds eight candidates of the left column of a pair, and of the
// right one; a vector holds as many pairs as fit.
template <int kThresholds, int kEntries>
class PixelWindows {
 public:
  PixelWindows(const WindowEvidenceRow& row, const ByteByDistance& by_distance)
      : direction_(row.direction),
        before_(row.direction < 0 ? kWindowCandidates - 1 : 0),
        by_distance_(by_distance),
        reference_(row.reference[0]),
        partner_(row.partner[0]) {}

  // Evidence of the pairs of a vector of D, in cells.
  template <class D>
  HWY_INLINE hn::VFromD<D> of_pairs(D d, int x, const std::int16_t* starts) const {
    constexpr std::size_t kPairs = hn::MaxLanes(D()) / 16;
    using Bytes =
        std::conditional_t<kPairs == 4, std::uint64_t,
                           std::conditional_t<kPairs == 2, std::uint32_t, std::uint16_t> >;
    const hn::Repartition<Bytes, D> of_bytes;
    std::ptrdiff_t first[kPairs];
#pragma GCC unroll 4
    for (std::size_t i = 0; i < kPairs; ++i) {
      const auto at = x + static_cast<std::ptrdiff_t>(kPair * i);
      first[i] = at + direction_ * starts[at] - before_;
    }
    const auto places =
        hn::LoadDup128(d, direction_ < 0 ? kPairPlaces.backwards : kPairPlaces.forwards);
    const auto own_places = hn::Load(d, kPairPlaces.of_own);
    CodeDistance<kThresholds, D> distance(d);
    distance.add(
        d,
        [&](std::size_t p) HWY_ATTR {
          Bytes bytes;
          std::memcpy(&bytes, reference_[p] + x, sizeof(bytes));
          return hn::TableLookupBytes(hn::BitCast(d, hn::Set(of_bytes, bytes)), own_places);
        },
        [&](std::size_t p)
            HWY_ATTR { return hn::TableLookupBytes(blocks_at(d, partner_[p], first), places); });
    return looked_up_bytes<kEntries>(d, by_distance_, distance.value());
  }

 private:
  // A block from each place.
  template <class D>
  static HWY_INLINE hn::VFromD<D> blocks_at(D d, const std::uint8_t* row,
                                            const std::ptrdiff_t* places) {
    if constexpr (hn::MaxLanes(D()) == 16) {
      return hn::LoadU(d, row + places[0]);
    } else {
      const hn::Half<D> half;
      return hn::Combine(d, blocks_at(half, row, places + hn::MaxLanes(D()) / 32),
                         blocks_at(half, row, places));
    }
  }

  std::ptrdiff_t direction_;
  std::ptrdiff_t before_;  // as that of SquareWindows
  ByteByDistance by_distance_;
  WindowEvidenceRow::Codes reference_;
  WindowEvidenceRow::Codes partner_;
};

// Evidence of whole vectors of D from column x on; returns the first column that is left.
template <int kThresholds, int kEntries, class D>
HWY_INLINE int evidence_of_pairs(D d, const PixelWindows<kThresholds, kEntries>& windows,
                                 const WindowEvidenceRow& row, int x,
                                 const std::array<WindowCells*, kWindows>& evidence) {
  const hn::Repartition<std::uint64_t, D> d64;
  constexpr int kColumns = static_cast<int>(hn::MaxLanes(d64));
  for (; x + kColumns <= row.columns; x += kColumns) {
    hn::StoreU(hn::BitCast(d64, windows.of_pairs(d, x, row.start[0])), d64, evidence[0] + x);
    std::uint8_t exists = 0;
#pragma GCC unroll 4
    for (int i = 0; i < kColumns; i += kPair) {
      exists |= row.has_second[x + i];
    }
    if (exists == 0) {
      hn::StoreU(hn::Zero(d64), d64, evidence[1] + x);
      continue;
    }
    hn::StoreU(hn::BitCast(d64, windows.of_pairs(d, x, row.start[1])), d64, evidence[1] + x);
#pragma GCC unroll 4
    for (int i = 0; i < kColumns; i += kPair) {
      if (row.has_second[x + i] == 0) {
        evidence[1][x + i] = evidence[1][x + i + 1] = 0;
      }
    }
  }
  return x;
}

template <int kThresholds, int kEntries>
HWY_INLINE void pixel_evidence(const WindowEvidenceRow& given, const ByteByDistance& by_distance,
                               const std::array<WindowCells*, kWindows>& evidence) {
  const WindowEvidenceRow row = given;  // a copy: stores cannot alias it
  const PixelWindows<kThresholds, kEntries> windows(row, by_distance);
  int x = evidence_of_pairs(TagBlocks(), windows, row, 0, evidence);
  if constexpr (kBlocks > 1) {
    x = evidence_of_pairs(TagBlock(), windows, row, x, evidence);
  }
  if (x < row.columns) {
    const hn::Repartition<std::uint64_t, TagBlock> d64;
    const auto of_window = [&](std::size_t q) HWY_ATTR {
      return hn::GetLane(hn::BitCast(d64, windows.of_pairs(TagBlock(), x, row.start[q])));
    };
    evidence[0][x] = of_window(0);
    evidence[1][x] = row.has_second[x] != 0 ? of_window(1) : 0;
  }
}

void evidence(const WindowEvidenceRow& row, const ByteByDistance& by_distance,
              const std::array<WindowCells*, kWindows>& evidence) {
  with_entries(row.thresholds, by_distance, [&](auto thresholds, auto entries) HWY_ATTR {
    constexpr int kThresholds = decltype(thresholds)::value;
    constexpr int kEntries = decltype(entries)::value;
    if (row.side == 1) {
      pixel_evidence<kThresholds, kEntries>(row, by_distance, evidence);
    } else {
      square_evidence<kThresholds, kEntries>(row, by_distance, evidence);
    }
  });
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(evidence);

void window_evidence_row(const WindowEvidenceRow& row, const ByteByDistance& by_distance,
                         const std::array<WindowCells*, kWindows>& evidence) {
  HWY_DYNAMIC_DISPATCH(evidence)(row, by_distance, evidence);
}

}  // namespace vantage::kernels
#endif
