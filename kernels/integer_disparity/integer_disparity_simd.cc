#include "kernels/simd-inl.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/integer_disparity/integer_disparity.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

int integer_disparity(const float* disparity_px, int width, std::uint16_t* stored) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> d32;
  const hn::Rebind<std::uint16_t, decltype(d)> d16;
  const auto largest = hn::Set(d, std::numeric_limits<float>::max());
  const auto one = hn::Set(d, 1.0F);
  const auto half = hn::Set(d, 0.5F);
  int x = 0;
  for (; x + static_cast<int>(hn::Lanes(d)) <= width; x += static_cast<int>(hn::Lanes(d))) {
    const auto disparity = hn::LoadU(d, disparity_px + x);
    const auto known = hn::Le(hn::Abs(disparity), largest);
    // Exact, as all that follows.
    const auto units = hn::Mul(disparity, hn::Set(d, kIntegerUnitsPerPx));
    const auto fits = hn::And(hn::Lt(hn::Neg(half), units), hn::Lt(units, hn::Set(d, 65535.5F)));
    if (!hn::AllFalse(d, hn::AndNot(fits, known))) {
      break;
    }
    const auto whole = hn::Trunc(hn::IfThenElseZero(known, units));
    const auto rounded =
        hn::Add(whole, hn::IfThenElseZero(hn::Ge(hn::Sub(units, whole), half), one));
    const auto value = hn::IfThenElseZero(known, hn::Max(rounded, one));
    hn::StoreU(hn::DemoteTo(d16, hn::ConvertTo(d32, value)), d16, stored + x);
  }
  return x + integer_disparity_row_ref(disparity_px + x, width - x, stored + x);
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(integer_disparity);

int integer_disparity_row(const float* disparity_px, int width, std::uint16_t* stored) {
  return HWY_DYNAMIC_DISPATCH(integer_disparity)(disparity_px, width, stored);
}

// Scalar reference.

int integer_disparity_row_ref(const float* disparity_px, int width, std::uint16_t* stored) {
  for (int x = 0; x < width; ++x) {
    if (!std::isfinite(disparity_px[x])) {
      stored[x] = 0;
      continue;
    }
    const double rounded = std::round(double{disparity_px[x]} * kIntegerUnitsPerPx);
    if (rounded < 0 || rounded > std::numeric_limits<std::uint16_t>::max()) {
      return x;
    }
    stored[x] = static_cast<std::uint16_t>(std::max(rounded, 1.0));
  }
  return width;
}

}  // namespace vantage::kernels
#endif
