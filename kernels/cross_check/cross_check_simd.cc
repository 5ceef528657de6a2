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

// Processes columns [begin, end) while whole vectors fit. Returns the first remaining column.
template <class D>
HWY_INLINE int check_columns(D d, const CrossCheckRow& row, const Tolerance& tolerance, int begin,
                             int end, const float* other_px) {
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
    const auto other = are_neighbours
                           ? hn::LoadU(d, other_px + first)
                           : hn::GatherIndex(d, other_px, hn::IfThenElseZero(is_inside, partner));
    const auto agrees =
        hn::And(hn::RebindMask(d, is_inside), differ_less(d, own, other, tolerance));
    const auto mark = hn::IfThenElse(hn::RebindMask(d_int, agrees), zero, hn::Set(d_int, 255));
    hn::StoreU(hn::DemoteTo(d_byte, mark), d_byte, row.unmatched + x);
  }
  return x;
}

void cross_check(const CrossCheckRow& row, const float* other_px) {
  const Tolerance tolerance(row.tolerance_px);
  const int done = check_columns(hn::ScalableTag<float>(), row, tolerance, 0, row.width, other_px);
  check_columns(hn::CappedTag<float, 1>(), row, tolerance, done, row.width, other_px);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(cross_check);

void cross_check_row(const CrossCheckRow& row, const float* other_px) {
  HWY_DYNAMIC_DISPATCH(cross_check)(row, other_px);
}

}  // namespace vantage::kernels
#endif
