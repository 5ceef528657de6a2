#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/cross_check/cross_check_simd.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, so that it is compiled once per target.
#include <hwy/highway.h>

#include "kernels/cross_check/cross_check.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct Check {
  const float* own_px;
  const float* other_px;
  double direction;
  double tolerance_px;
  int width;
  std::uint8_t* unmatched;
};

// Processes columns [begin, end) while whole vectors fit. Returns the first remaining column.
template <class D>
HWY_INLINE int check_columns(D d, const Check& check, int begin, int end) {
  const hn::Rebind<float, D> d_float;
  const hn::Rebind<std::int32_t, D> d_int;
  const hn::Rebind<std::uint8_t, D> d_byte;
  const int step = static_cast<int>(hn::Lanes(d));
  const auto direction = hn::Set(d, check.direction);
  const auto tolerance = hn::Set(d, check.tolerance_px);
  const auto width = hn::Set(d, static_cast<double>(check.width));
  const auto half = hn::Set(d, 0.5);
  const auto zero = hn::Zero(d);
  const auto marked = hn::Set(d, 255.0);
  int x = begin;
  for (; x + step <= end; x += step) {
    const auto own = hn::PromoteTo(d, hn::LoadU(d_float, check.own_px + x));
    // Not Iota(d, x): only a constant start avoids a detour through memory.
    const auto column = hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<double>(x)));
    const auto partner = hn::Floor(hn::Add(hn::Add(column, hn::Mul(direction, own)), half));
    // False for NaN.
    const auto inside = hn::And(hn::Ge(partner, zero), hn::Lt(partner, width));
    const auto place = hn::DemoteTo(d_int, hn::IfThenElseZero(inside, partner));
    const auto other = hn::PromoteTo(d, hn::GatherIndex(d_float, check.other_px, place));
    const auto agrees = hn::And(inside, hn::Lt(hn::Abs(hn::Sub(own, other)), tolerance));
    const auto mark = hn::DemoteTo(d_int, hn::IfThenElse(agrees, zero, marked));
    hn::StoreU(hn::DemoteTo(d_byte, mark), d_byte, check.unmatched + x);
  }
  return x;
}

void cross_check(const float* own_px, const float* other_px, int direction, double tolerance_px,
                 int width, std::uint8_t* unmatched) {
  const Check check{own_px,       other_px, static_cast<double>(direction),
                    tolerance_px, width,    unmatched};
  const int done = check_columns(hn::ScalableTag<double>(), check, 0, width);
  check_columns(hn::CappedTag<double, 1>(), check, done, width);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(cross_check);

void cross_check_row(const float* own_px, const float* other_px, int direction, double tolerance_px,
                     int width, std::uint8_t* unmatched) {
  HWY_DYNAMIC_DISPATCH(cross_check)(own_px, other_px, direction, tolerance_px, width, unmatched);
}

}  // namespace vantage::kernels
#endif
