#include "kernels/simd-inl.h"

#include <cmath>
#include <limits>

#include "kernels/cross_check/cross_check.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// The tolerance as a float and what is missing, rounded up.
struct Tolerance {
  explicit Tolerance(double px)
      : rounded(static_cast<float>(px)), rest(static_cast<float>(px - rounded)) {
    if (rest < px - rounded) {
      rest = std::nextafter(rest, std::numeric_limits<float>::infinity());
    }
  }
  float rounded;
  float rest;
};

// Whether |a − b| is less than the tolerance, as if nothing were rounded; false for NaN.
template <class D, class V>
HWY_INLINE auto differ_less(D d, V a, V b, const Tolerance& tolerance) {
  const V rounded = hn::Set(d, tolerance.rounded);
  const V difference = hn::Sub(a, b);
  const V size = hn::Abs(difference);
  // What the difference has lost by rounding, exactly (Knuth's TwoSum). It decides where the
  // rounded difference is the rounded tolerance, and is less than the step to the next float
  // elsewhere.
  const V taken = hn::Sub(difference, a);
  const V lost = hn::Sub(hn::Sub(a, hn::Sub(difference, taken)), hn::Add(b, taken));
  const V sign = hn::CopySignToAbs(hn::Set(d, 1.0F), difference);
  const auto is_less = hn::Lt(size, rounded);
  const auto is_equal = hn::Eq(size, rounded);
  const auto is_less_exactly = hn::Lt(hn::Mul(lost, sign), hn::Set(d, tolerance.rest));
  return hn::Or(is_less, hn::And(is_equal, is_less_exactly));
}

// A row of the other map.
struct OtherMap {
  const float* px;

  template <class D>
  HWY_INLINE hn::VFromD<D> load(D d, int first) const {
    return hn::LoadU(d, px + first);
  }
  template <class D, class V>
  HWY_INLINE hn::VFromD<D> gather(D d, V columns) const {
    return hn::GatherIndex(d, px, columns);
  }
};

struct OtherWinners {
  CoarseWinnerRow row;
  int last;  // index of the last winner

  // Neighbouring columns from `first` on.
  template <class D>
  HWY_INLINE hn::VFromD<D> load(D d, int first) const {
    const hn::RebindToSigned<D> d_int;
    const int lanes = static_cast<int>(hn::Lanes(d));
    // A whole vector of winners that holds those of all lanes.
    const int start = HWY_MAX(0, HWY_MIN(first >> row.level, last + 1 - lanes));
    if (start + lanes > last + 1) {
      return gather(d, hn::Add(hn::Iota(d_int, 0), hn::Set(d_int, first)));
    }
    const auto columns = hn::Add(hn::Iota(d_int, 0), hn::Set(d_int, first - (start << row.level)));
    const auto lane = hn::ShiftRightSame(columns, row.level);
    return disparities(d, hn::TableLookupLanes(hn::LoadU(d_int, row.winners + start),
                                               hn::IndicesFromVec(d_int, lane)));
  }
  template <class D, class V>
  HWY_INLINE hn::VFromD<D> gather(D d, V columns) const {
    const hn::RebindToSigned<D> d_int;
    return disparities(d,
                       hn::GatherIndex(d_int, row.winners, hn::ShiftRightSame(columns, row.level)));
  }
  template <class D, class V>
  HWY_INLINE hn::VFromD<D> disparities(D d, V winners) const {
    return hn::Mul(
        hn::ConvertTo(d, hn::Add(winners, hn::Set(hn::RebindToSigned<D>(), row.disparity_min))),
        hn::Set(d, row.px_per_candidate));
  }
};

// Processes columns [begin, end) while whole vectors fit; other_px reads the other map.
// Returns the first remaining column.
template <class D, class Other>
HWY_INLINE int check_columns(D d, const CrossCheckRow& row, const Tolerance& tolerance, int begin,
                             int end, const Other& other_px) {
  // Farther than any row is wide, and with halves.
  constexpr float kFar = 1 << 22;
  const hn::RebindToSigned<D> d_int;
  const hn::Rebind<std::uint8_t, D> d_byte;
  const int step = static_cast<int>(hn::Lanes(d));
  const auto direction = hn::Set(d, static_cast<float>(row.direction) * row.columns_per_px);
  const auto zero = hn::Zero(d_int);
  const auto before = hn::Set(d_int, -1);
  const auto width = hn::Set(d_int, row.width);
  int x = begin;
  for (; x + step <= end; x += step) {
    const auto own = hn::LoadU(d, row.own_px + x);
    const auto is_near = hn::Lt(hn::Abs(own), hn::Set(d, kFar));  // false for NaN
    const auto shift = hn::Mul(direction, hn::IfThenElseZero(is_near, own));
    // floor(x + shift + ½), without a sum that rounds.
    const auto whole = hn::Floor(shift);
    const auto is_up = hn::Ge(hn::Sub(shift, whole), hn::Set(d, 0.5F));
    const auto up = hn::IfThenElseZero(hn::RebindMask(d_int, is_up), hn::Set(d_int, 1));
    // Not Iota(d, x): only a constant start avoids a detour through memory.
    const auto column = hn::Add(hn::Iota(d_int, 0), hn::Set(d_int, x));
    const auto columns = hn::Add(hn::ConvertTo(d_int, whole), up);
    const auto partner = hn::Add(column, columns);
    const auto is_inside = hn::And(hn::RebindMask(d_int, is_near),
                                   hn::And(hn::Gt(partner, before), hn::Lt(partner, width)));
    // Partners are mostly neighbours, which are loaded in less time than they are gathered.
    const int first = x + hn::GetLane(columns);
    const bool are_neighbours =
        step > 1 &&
        hn::AllTrue(d_int, hn::And(is_inside, hn::Eq(columns, hn::Set(d_int, first - x))));
    const auto other = are_neighbours ? other_px.load(d, first)
                                      : other_px.gather(d, hn::IfThenElseZero(is_inside, partner));
    const auto agrees =
        hn::And(hn::RebindMask(d, is_inside), differ_less(d, own, other, tolerance));
    const auto mark = hn::IfThenElse(hn::RebindMask(d_int, agrees), zero, hn::Set(d_int, 255));
    hn::StoreU(hn::DemoteTo(d_byte, mark), d_byte, row.unmatched + x);
  }
  return x;
}

template <class Other>
HWY_INLINE void check_row(const CrossCheckRow& row, const Other& other_px) {
  const Tolerance tolerance(row.tolerance_px);
  const int done = check_columns(hn::ScalableTag<float>(), row, tolerance, 0, row.width, other_px);
  check_columns(hn::CappedTag<float, 1>(), row, tolerance, done, row.width, other_px);
}

void cross_check(const CrossCheckRow& row, const float* other_px) {
  check_row(row, OtherMap{other_px});
}

void cross_check_winners(const CrossCheckRow& row, const CoarseWinnerRow& other) {
  check_row(row, OtherWinners{other, (row.width - 1) >> other.level});
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(cross_check);
HWY_EXPORT(cross_check_winners);

void cross_check_row(const CrossCheckRow& row, const float* other_px) {
  HWY_DYNAMIC_DISPATCH(cross_check)(row, other_px);
}
void cross_check_winners_row(const CrossCheckRow& row, const CoarseWinnerRow& other) {
  HWY_DYNAMIC_DISPATCH(cross_check_winners)(row, other);
}

}  // namespace vantage::kernels
#endif
