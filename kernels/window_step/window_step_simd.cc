#include "kernels/simd-inl.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "kernels/window_step/window_step.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// One window per 64-bit lane. Its bytes become two vectors of words, those of even and of odd
// candidates, which need no widening.
using Tag64 = hn::ScalableTag<std::uint64_t>;
using Tag32 = hn::Repartition<std::uint32_t, Tag64>;
using Tag16 = hn::Repartition<std::uint16_t, Tag64>;
using TagS16 = hn::Repartition<std::int16_t, Tag64>;
using Tag8 = hn::Repartition<std::uint8_t, Tag64>;
using Vec64 = hn::VFromD<Tag64>;
using Vec16 = hn::VFromD<Tag16>;
using VecS16 = hn::VFromD<TagS16>;
using Vec8 = hn::VFromD<Tag8>;
constexpr int kColumns = static_cast<int>(hn::MaxLanes(Tag64()));
static_assert(kColumns <= 8 && kColumns <= kWindowMargin);

// Table lookups that distribute the first kColumns of eight words (the same in every block) to
// 64-bit lanes.
struct Distribution {
  alignas(64) std::uint8_t to_all_words[64];  // to each of a lane's four words
  alignas(64) std::uint8_t of_odd[64];        // the same, to a pair of lanes its odd one's word
  alignas(64) std::uint8_t low_bytes[64];     // their low bytes, to all bytes of a lane
  alignas(64) std::uint8_t bytes[64];         // of eight bytes: to all bytes of a lane
  alignas(64) std::uint8_t candidates[64];    // no lookup: a lane's candidates
  alignas(64) std::uint8_t from_120[64];      // exclusive or: 120 to 127 to bytes of the lane
};
constexpr Distribution distribution() {
  Distribution to{};
  for (int column = 0; column < 8; ++column) {
    for (int byte = 0; byte < 8; ++byte) {
      const auto at = static_cast<std::size_t>(8 * column + byte);
      to.to_all_words[at] = static_cast<std::uint8_t>(2 * column + byte % 2);
      to.of_odd[at] = static_cast<std::uint8_t>(2 * (column | 1) + byte % 2);
      to.low_bytes[at] = static_cast<std::uint8_t>(2 * column);
      to.bytes[at] = static_cast<std::uint8_t>(column);
      to.candidates[at] = static_cast<std::uint8_t>(byte);
      to.from_120[at] = column % 2 == 0 ? 120 : 112;
    }
  }
  return to;
}
constexpr Distribution kTo = distribution();

HWY_INLINE Vec16 distributed(VecS16 words, const std::uint8_t* places) {
  const Tag8 d8;
  return hn::BitCast(Tag16(), hn::TableLookupBytes(hn::BitCast(d8, words), hn::Load(d8, places)));
}
HWY_INLINE Vec16 words_of(const FixedWeight* values) {
  return distributed(hn::LoadDup128(TagS16(), values), kTo.to_all_words);
}

HWY_INLINE Vec64 mask_of(const std::uint8_t* bytes) {
  const Tag8 d8;
  return hn::BitCast(Tag64(),
                     hn::TableLookupBytes(hn::LoadDup128(d8, bytes), hn::Load(d8, kTo.bytes)));
}

// Table lookups that move cells of windows that begin at `start` to the lanes of windows that begin
// at `own`.
HWY_INLINE Vec8 move_between(VecS16 start, VecS16 own) {
  const Tag8 d8;
  const TagS16 ds16;
  // By whole windows and more: everything is moved out.
  const VecS16 limit = hn::Set(ds16, kWindowCandidates);
  const VecS16 later = hn::Min(hn::Max(hn::Sub(own, start), hn::Neg(limit)), limit);
  const Vec8 from =
      hn::Add(hn::TableLookupBytes(hn::BitCast(d8, later), hn::Load(d8, kTo.low_bytes)),
              hn::Load(d8, kTo.candidates));
  // Sets the top bit of all but 0 to 7, which become 120 to 127.
  const Vec8 checked = hn::SaturatedAdd(from, hn::Set(d8, 120));
  return hn::Xor(checked, hn::Load(d8, kTo.from_120));
}
HWY_INLINE Vec64 moved(Vec64 cells, Vec8 move) {
  return hn::BitCast(Tag64(), hn::TableLookupBytesOr0(hn::BitCast(Tag8(), cells), move));
}

struct Totals {
  Vec16 even, odd;
};

HWY_INLINE Totals evidence_of(const WindowCells* evidence) {
  static_assert(kWindowTotalUnits == 4);
  const Tag16 d16;
  const Vec16 cells = hn::BitCast(d16, hn::LoadU(Tag64(), evidence));
  const Vec16 within = hn::Set(d16, 0x3FC);
  return {hn::And(hn::ShiftLeft<2>(cells), within), hn::And(hn::ShiftRight<6>(cells), within)};
}

HWY_INLINE void add(Vec64 support, Vec16 weight, Totals& totals) {
  const Tag16 d16;
  const Vec16 cells = hn::BitCast(d16, support);
  const Vec16 within = hn::Set(d16, 0x7F8);  // eight times a cell
  totals.even = hn::Add(totals.even, hn::MulHigh(hn::And(hn::ShiftLeft<3>(cells), within), weight));
  totals.odd = hn::Add(totals.odd, hn::MulHigh(hn::And(hn::ShiftRight<5>(cells), within), weight));
}

// The largest word of each 64-bit lane, in all its words.
HWY_INLINE Vec16 max_of_lane(Vec16 words) {
  const Tag16 d16;
  const Tag32 d32;
#if HWY_TARGET <= HWY_AVX3
  const Vec16 halves =
      hn::Max(words, hn::BitCast(d16, hn::RotateRight<32>(hn::BitCast(Tag64(), words))));
  return hn::Max(halves, hn::BitCast(d16, hn::RotateRight<16>(hn::BitCast(d32, halves))));
#else
  // Shuffles, because rotations would be two shifts and more.
  alignas(16) static constexpr std::uint8_t kOtherWords[16] = {2,  3,  0, 1, 6,  7,  4,  5,
                                                               10, 11, 8, 9, 14, 15, 12, 13};
  const Tag8 d8;
  const Vec16 halves = hn::Max(words, hn::BitCast(d16, hn::Shuffle2301(hn::BitCast(d32, words))));
  return hn::Max(halves, hn::BitCast(d16, hn::TableLookupBytes(hn::BitCast(d8, halves),
                                                               hn::LoadDup128(d8, kOtherWords))));
#endif
}

// T of kColumns columns, the first one even. kBoth: neighbours may have second windows.
template <bool kBoth>
class ColumnTotals {
 public:
  ColumnTotals(const WindowStepRow& row, int x)
      : row_(row),
        x_(x),
        mu_(hn::Set(Tag16(), static_cast<std::uint16_t>(row.mu))),
        inner_(distributed(hn::LoadDup128(TagS16(), row.beside + x), kTo.of_odd)),
        outer_(distributed(hn::OddEven(hn::LoadDup128(TagS16(), row.beside + x + 1),
                                       hn::LoadDup128(TagS16(), row.beside + x)),
                           kTo.to_all_words)),
        up_(words_of(row.above + x)),
        down_(words_of(row.below + x)),
        up_is_alike_(row.up.start == row.centre.start),
        down_is_alike_(row.down.start == row.centre.start) {}

  [[nodiscard]] HWY_INLINE Totals of(std::size_t window) const {
    const TagS16 ds16;
    Totals totals = evidence_of(row_.evidence[window] + x_);
    const VecS16 own = hn::LoadDup128(ds16, row_.centre.start[window] + x_);
    const Vec8 from_other =
        kBoth ? move_between(hn::LoadDup128(ds16, row_.centre.start[1 - window] + x_), own)
              : hn::Zero(Tag8());
    const Vec64 centre = alike_support(row_.centre, window, from_other);
    add(centre, mu_, totals);
    // Of the columns beside one, that of its pair has the same windows.
    add(hn::Shuffle01(centre), inner_, totals);
    add(support<true>(row_.centre, own), outer_, totals);
    add(up_is_alike_ ? alike_support(row_.up, window, from_other) : support<false>(row_.up, own),
        up_, totals);
    add(down_is_alike_ ? alike_support(row_.down, window, from_other)
                       : support<false>(row_.down, own),
        down_, totals);
    return totals;
  }

 private:
  // Of the columns themselves, or of those beside their pairs.
  template <bool kBeside>
  [[nodiscard]] HWY_INLINE Vec64 cells_of(const WindowRow& row, std::size_t window) const {
    const WindowCells* const cells = row.support[window] + x_;
    const Tag64 d64;
    return kBeside ? hn::OddEven(hn::LoadU(d64, cells + 1), hn::LoadU(d64, cells - 1))
                   : hn::LoadU(d64, cells);
  }
  template <bool kBeside>
  [[nodiscard]] HWY_INLINE Vec64 moved_cells(const WindowRow& row, std::size_t window, Vec64 cells,
                                             VecS16 own) const {
    const std::int16_t* const start = row.start[window] + x_;
    const TagS16 ds16;
    return moved(cells, move_between(kBeside ? hn::OddEven(hn::LoadDup128(ds16, start + 1),
                                                           hn::LoadDup128(ds16, start - 1))
                                             : hn::LoadDup128(ds16, start),
                                     own));
  }
  template <bool kBeside>
  [[nodiscard]] HWY_INLINE Vec64 support(const WindowRow& row, VecS16 own) const {
    const Vec64 first = moved_cells<kBeside>(row, 0, cells_of<kBeside>(row, 0), own);
    if constexpr (kBoth) {
      const Vec64 second = cells_of<kBeside>(row, 1);
      if (!is_zero(second)) {
        return larger(first, moved_cells<kBeside>(row, 1, second, own));
      }
    }
    return first;
  }
  // Same for rows whose windows begin where those of the centre do: that of `window` is not moved.
  [[nodiscard]] HWY_INLINE Vec64 alike_support(const WindowRow& row, std::size_t window,
                                               Vec8 from_other) const {
    const Vec64 same = cells_of<false>(row, window);
    if constexpr (kBoth) {
      const Vec64 other = cells_of<false>(row, 1 - window);
      if (!is_zero(other)) {
        return larger(same, moved(other, from_other));
      }
    }
    return same;
  }
  static HWY_INLINE bool is_zero(Vec64 cells) {
    return hn::AllTrue(Tag64(), hn::Eq(cells, hn::Zero(Tag64())));
  }
  static HWY_INLINE Vec64 larger(Vec64 cells, Vec64 others) {
    const Tag8 d8;
    return hn::BitCast(Tag64(), hn::Max(hn::BitCast(d8, cells), hn::BitCast(d8, others)));
  }

  const WindowStepRow& row_;
  int x_;
  Vec16 mu_;
  Vec16 inner_;
  Vec16 outer_;
  Vec16 up_;
  Vec16 down_;
  bool up_is_alike_;
  bool down_is_alike_;
};

// Cells from quarters of a step, at most 255 after rounding.
HWY_INLINE Vec64 packed(const Totals& quarters, WindowCells lanes) {
  const Tag16 d16;
  const Vec16 half = hn::Set(d16, 2);
  const Vec16 max = hn::Set(d16, 255);
  const Vec16 even = hn::Min(hn::ShiftRight<2>(hn::Add(quarters.even, half)), max);
  const Vec16 odd = hn::Min(hn::ShiftRight<2>(hn::Add(quarters.odd, half)), max);
  return hn::And(hn::BitCast(Tag64(), hn::Or(even, hn::ShiftLeft<8>(odd))),
                 hn::Set(Tag64(), lanes));
}

// max(0, T − max + ceiling).
HWY_INLINE Totals above_floor(const Totals& totals, Vec16 max, Vec16 ceiling) {
  return {hn::SaturatedSub(hn::Add(totals.even, ceiling), max),
          hn::SaturatedSub(hn::Add(totals.odd, ceiling), max)};
}

// Words of candidates `kLanes` even or odd places before, or after (−kLanes), in their window.
template <int kLanes>
HWY_INLINE Vec16 from_beside(Vec16 words) {
  const Tag16 d16;
  const Vec64 lanes = hn::BitCast(Tag64(), words);
  if constexpr (kLanes == 0) {
    return words;
  } else if constexpr (kLanes >= 4 || kLanes <= -4) {
    return hn::Zero(d16);  // beyond the window; not all targets shift by all bits of a lane
  } else if constexpr (kLanes > 0) {
    return hn::BitCast(d16, hn::ShiftLeft<16 * kLanes>(lanes));
  } else {
    return hn::BitCast(d16, hn::ShiftRight<-16 * kLanes>(lanes));
  }
}

template <int kOffset>
HWY_INLINE void smooth(const Totals& totals, const WindowPrior& prior, Totals& smoothed) {
  if (prior.radius < kOffset) {
    return;
  }
  const Vec16 rise = hn::Set(Tag16(), prior.rises[kOffset - 1]);
  constexpr int kHalf = kOffset / 2;
  Vec16 even;
  Vec16 odd;
  if constexpr (kOffset % 2 == 0) {
    even = hn::Max(from_beside<kHalf>(totals.even), from_beside<-kHalf>(totals.even));
    odd = hn::Max(from_beside<kHalf>(totals.odd), from_beside<-kHalf>(totals.odd));
  } else {
    // Candidate 2i lies beside 2i − 1 and 2i + 1, odd ones of places i − 1 and i.
    even = hn::Max(from_beside<kHalf + 1>(totals.odd), from_beside<-kHalf>(totals.odd));
    odd = hn::Max(from_beside<kHalf>(totals.even), from_beside<-kHalf - 1>(totals.even));
  }
  smoothed.even = hn::Max(smoothed.even, hn::SaturatedSub(even, rise));
  smoothed.odd = hn::Max(smoothed.odd, hn::SaturatedSub(odd, rise));
}

HWY_INLINE Totals smoothed(const Totals& totals, const WindowPrior& prior) {
  Totals result = totals;
  smooth<1>(totals, prior, result);
  if (prior.radius > 1) {
    smooth<2>(totals, prior, result);
    smooth<3>(totals, prior, result);
    smooth<4>(totals, prior, result);
    smooth<5>(totals, prior, result);
    smooth<6>(totals, prior, result);
    smooth<7>(totals, prior, result);
  }
  return result;
}

// Whether one of the columns of a vector is marked.
HWY_INLINE bool any_of(const std::uint8_t* marks) {
  std::uint64_t any = 0;
  std::memcpy(&any, marks, kColumns);
  return any != 0;
}

HWY_INLINE Totals masked(const Totals& totals, Vec64 mask) {
  const Vec16 words = hn::BitCast(Tag16(), mask);
  return {hn::And(totals.even, words), hn::And(totals.odd, words)};
}

void step(const WindowStepRow& given, const std::array<WindowCells*, kWindows>& support) {
  const Tag64 d64;
  const Tag16 d16;
  const WindowStepRow row = given;  // a copy: stores cannot alias it
  WindowCells* const first_support = support[0];
  WindowCells* const second_support = support[1];
  const Vec16 ceiling = hn::Set(d16, row.prior.ceiling);
  for (int x = 0; x < row.columns; x += kColumns) {
    const auto store_first = [&](const Totals& first) HWY_ATTR {
      const Vec16 max = max_of_lane(hn::Max(first.even, first.odd));
      hn::StoreU(packed(above_floor(smoothed(first, row.prior), max, ceiling), row.prior.lanes),
                 d64, first_support + x);
      hn::StoreU(hn::Zero(d64), d64, second_support + x);
    };
    if (!any_of(row.near_second + x)) {
      store_first(ColumnTotals<false>(row, x).of(0));
      continue;
    }
    const ColumnTotals<true> totals(row, x);
    const Totals first = totals.of(0);
    if (!any_of(row.has_second + x)) {
      store_first(first);
      continue;
    }
    const Vec64 exists = hn::And(mask_of(row.has_second + x), mask_of(row.near_second + x));
    const Totals second = masked(totals.of(1), exists);
    const Vec16 max =
        max_of_lane(hn::Max(hn::Max(first.even, first.odd), hn::Max(second.even, second.odd)));
    hn::StoreU(packed(above_floor(smoothed(first, row.prior), max, ceiling), row.prior.lanes), d64,
               first_support + x);
    hn::StoreU(hn::And(exists, packed(above_floor(smoothed(second, row.prior), max, ceiling),
                                      row.prior.lanes)),
               d64, second_support + x);
  }
  for (WindowCells* const cells : {first_support, second_support}) {
    std::fill_n(cells + row.columns, kWindowMargin, WindowCells{0});
  }
}

// Words with a code for each candidate of a window: T + 1, and the lane, larger for smaller
// candidates. 0 for candidates that may not win.
struct Codes {
  Vec16 even, odd;
};

HWY_INLINE Codes codes_of(const Totals& totals, Vec64 selectable) {
  const Tag16 d16;
  alignas(16) static constexpr std::uint16_t kEven[8] = {7, 5, 3, 1, 7, 5, 3, 1};
  alignas(16) static constexpr std::uint16_t kOdd[8] = {6, 4, 2, 0, 6, 4, 2, 0};
  const Vec16 one = hn::Set(d16, 1);
  const auto code = [&](Vec16 total, const std::uint16_t* lanes) HWY_ATTR {
    return hn::Or(hn::ShiftLeft<3>(hn::Add(total, one)), hn::LoadDup128(d16, lanes));
  };
  // Bytes of 255 or 0, widened to words.
  const TagS16 ds16;
  const auto bytes = hn::BitCast(ds16, selectable);
  const Vec16 is_even = hn::BitCast(d16, hn::ShiftRight<8>(hn::ShiftLeft<8>(bytes)));
  const Vec16 is_odd = hn::BitCast(d16, hn::ShiftRight<8>(bytes));
  return {hn::And(code(totals.even, kEven), is_even), hn::And(code(totals.odd, kOdd), is_odd)};
}

// T of the winners' neighbours in the window, in all words of a lane.
struct Beside {
  Vec16 before, after;
};

HWY_INLINE Beside beside_winner(const Totals& totals, const Codes& codes, Vec16 best) {
  const auto even_wins = hn::Eq(codes.even, best);
  const auto odd_wins = hn::Eq(codes.odd, best);
  const Vec16 before = hn::Max(hn::IfThenElseZero(even_wins, from_beside<1>(totals.odd)),
                               hn::IfThenElseZero(odd_wins, totals.even));
  const Vec16 after = hn::Max(hn::IfThenElseZero(even_wins, totals.odd),
                              hn::IfThenElseZero(odd_wins, from_beside<-1>(totals.even)));
  // Without a winner all codes are 0.
  const auto is_none = hn::Eq(best, hn::Zero(Tag16()));
  return {hn::IfThenZeroElse(is_none, max_of_lane(before)),
          hn::IfThenZeroElse(is_none, max_of_lane(after))};
}

HWY_INLINE Vec64 selectable_of(const WindowCells* selectable, int x, WindowCells lanes) {
  const Tag64 d64;
  const Vec64 all = hn::Set(d64, lanes);
  return selectable == nullptr ? all : hn::And(hn::LoadU(d64, selectable + x), all);
}

// The low bytes or words of lanes.
template <typename T>
HWY_INLINE void store_low(Vec16 words, T* values) {
  const hn::Rebind<T, Tag64> d;
  hn::StoreU(hn::TruncateTo(d, hn::BitCast(Tag64(), words)), d, values);
}

void winners(const WindowStepRow& given, const WindowWinners& given_winners) {
  const Tag64 d64;
  const Tag16 d16;
  const WindowStepRow row = given;  // copies: stores cannot alias them
  const WindowWinners winners = given_winners;
  const Vec16 ceiling = hn::Set(d16, row.prior.ceiling);
  for (int x = 0; x < row.columns; x += kColumns) {
    const bool is_near = any_of(row.near_second + x);
    const bool both = is_near && any_of(row.has_second + x);
    Totals first;
    Totals second{hn::Zero(d16), hn::Zero(d16)};
    Vec64 second_selectable = hn::Zero(d64);
    if (both) {
      const ColumnTotals<true> totals(row, x);
      const Vec64 exists = hn::And(mask_of(row.has_second + x), mask_of(row.near_second + x));
      first = totals.of(0);
      second = masked(totals.of(1), exists);
      second_selectable = hn::And(exists, selectable_of(winners.selectable[1], x, row.prior.lanes));
    } else {
      first = is_near ? ColumnTotals<true>(row, x).of(0) : ColumnTotals<false>(row, x).of(0);
    }
    const Codes first_codes =
        codes_of(first, selectable_of(winners.selectable[0], x, row.prior.lanes));
    Vec16 best = max_of_lane(hn::Max(first_codes.even, first_codes.odd));
    Beside beside = beside_winner(first, first_codes, best);
    Totals chosen = first;
    Vec16 window = hn::Zero(d16);
    if (both) {
      const Codes codes = codes_of(second, second_selectable);
      const Vec16 second_best = max_of_lane(hn::Max(codes.even, codes.odd));
      const Beside of_second = beside_winner(second, codes, second_best);
      const auto wins = hn::Gt(hn::ShiftRight<3>(second_best), hn::ShiftRight<3>(best));
      best = hn::IfThenElse(wins, second_best, best);
      beside = {hn::IfThenElse(wins, of_second.before, beside.before),
                hn::IfThenElse(wins, of_second.after, beside.after)};
      chosen = {hn::IfThenElse(wins, second.even, first.even),
                hn::IfThenElse(wins, second.odd, first.odd)};
      window = hn::IfThenElseZero(wins, hn::Set(d16, 1));
    }
    const auto is_none = hn::Eq(best, hn::Zero(d16));
    const Vec16 lane = hn::Sub(hn::Set(d16, 7), hn::And(best, hn::Set(d16, 7)));
    store_low(hn::IfThenElse(is_none, hn::Set(d16, kNoWindow), window), winners.window + x);
    store_low(hn::IfThenZeroElse(is_none, lane), winners.lane + x);
    store_low(hn::SaturatedSub(hn::ShiftRight<3>(best), hn::Set(d16, 1)), winners.total + x);
    store_low(beside.before, winners.total_before + x);
    store_low(beside.after, winners.total_after + x);
    if (winners.support != nullptr) {
      const Vec16 max =
          max_of_lane(hn::Max(hn::Max(first.even, first.odd), hn::Max(second.even, second.odd)));
      hn::StoreU(packed(above_floor(chosen, max, ceiling), row.prior.lanes), d64,
                 winners.support + x);
    }
  }
}

void disparities(const WindowDisparities& row, float* disparity_px) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  const hn::Rebind<std::uint16_t, decltype(d)> d16;
  const hn::Rebind<std::int16_t, decltype(d)> ds16;
  const WindowWinners winners = *row.winners;
  const auto [first_start, second_start] = row.start;
  const int step = static_cast<int>(hn::Lanes(d));
  const auto zero = hn::Zero(di);
  const auto min = hn::Set(di, row.disparity_min);
  const auto last_lane = hn::Set(di, row.candidates - 1);
  const auto is_refined = hn::Set(di, row.is_refined ? 1 : 0);
  const auto unknown = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  int x = 0;
  for (; x + step <= row.columns; x += step) {
    const auto window = hn::PromoteTo(di, hn::LoadU(d8, winners.window + x));
    const auto lane = hn::PromoteTo(di, hn::LoadU(d8, winners.lane + x));
    const auto total = hn::PromoteTo(di, hn::LoadU(d16, winners.total + x));
    const auto before = hn::PromoteTo(di, hn::LoadU(d16, winners.total_before + x));
    const auto after = hn::PromoteTo(di, hn::LoadU(d16, winners.total_after + x));
    const auto first = hn::PromoteTo(di, hn::LoadU(ds16, first_start + x));
    const auto second = hn::PromoteTo(di, hn::LoadU(ds16, second_start + x));
    const auto start = hn::IfThenElse(hn::Eq(window, hn::Set(di, 1)), second, first);
    const auto whole = hn::ConvertTo(d, hn::Add(min, hn::Add(start, lane)));
    const auto curvature = hn::Sub(hn::Add(total, total), hn::Add(before, after));
    const auto moves = hn::And(hn::And(hn::Gt(lane, zero), hn::Lt(lane, last_lane)),
                               hn::And(hn::Gt(curvature, zero), hn::Gt(is_refined, zero)));
    const auto offset = hn::Div(
        hn::ConvertTo(d, hn::Sub(after, before)),
        hn::ConvertTo(d, hn::IfThenElse(moves, hn::Add(curvature, curvature), hn::Set(di, 1))));
    const auto moved = hn::IfThenElse(hn::RebindMask(d, moves), hn::Add(whole, offset), whole);
    const auto is_none = hn::RebindMask(d, hn::Eq(window, hn::Set(di, kNoWindow)));
    hn::StoreU(hn::IfThenElse(is_none, unknown, moved), d, disparity_px + x);
  }
  window_disparity_row_ref(row, x, row.columns, disparity_px);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(step);
HWY_EXPORT(winners);
HWY_EXPORT(disparities);

void window_step_row(const WindowStepRow& row, const std::array<WindowCells*, kWindows>& support) {
  HWY_DYNAMIC_DISPATCH(step)(row, support);
}
void window_winners_row(const WindowStepRow& row, const WindowWinners& winners) {
  HWY_DYNAMIC_DISPATCH(winners)(row, winners);
}
void window_disparity_row(const WindowDisparities& row, float* disparity_px) {
  HWY_DYNAMIC_DISPATCH(disparities)(row, disparity_px);
}

}  // namespace vantage::kernels
#endif
