#include "kernels/simd-inl.h"

#include <cstddef>
#include <cstdint>

#include "kernels/bilateral/bilateral.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// The share of the weighted differences in the weights, of half a vector, in steps.
template <class D, class V>
HWY_INLINE V quotient(D d, V differences, V weights) {
  const hn::Rebind<std::int32_t, D> d32;
  const hn::Rebind<float, D> df;
  const auto scaled = hn::Mul(hn::ConvertTo(df, hn::PromoteTo(d32, differences)),
                              hn::Set(df, static_cast<float>(kBilateralOne)));
  const auto of = hn::PromoteTo(d32, hn::BitCast(hn::RebindToUnsigned<D>(), weights));
  return hn::DemoteTo(d, hn::NearestInt(hn::Div(scaled, hn::ConvertTo(df, of))));
}

// By how many bits (1 − (d / cut_off)²) is shifted, so that weights are as exact as 16 bits allow:
// of the sum of all, and of two with a sign. `limit`: the square at the cut-off.
int weight_shift(const BilateralRow& row, int limit) {
  double sum = 1;
  for (const BilateralPair& pair : row.pairs) {
    sum += 2.0 * pair.weight / kBilateralOne;
  }
  sum = sum < 4 ? 4 : sum;
  int shift = 0;
  while (4.0 * limit * limit * sum < 0x1p31) {
    limit *= 2;
    ++shift;
  }
  return shift;
}

void bilateral(const BilateralRow& row) {
  const hn::CappedTag<std::int16_t, kBilateralColumns> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::Half<decltype(d)> half;
  const int limit = (row.cut_off * row.cut_off + kBilateralOne / 2) / kBilateralOne;
  const int shift = weight_shift(row, limit);
  const auto limits = hn::Set(du, static_cast<std::uint16_t>(limit));
  const auto weight_of = [&](auto difference) HWY_ATTR {
    const auto square = hn::BitCast(du, hn::MulFixedPoint15(difference, difference));
    const auto root = hn::BitCast(d, hn::ShiftLeftSame(hn::SaturatedSub(limits, square), shift));
    return hn::MulFixedPoint15(root, root);
  };
  const auto of_centre = weight_of(hn::Zero(d));
  for (int x = 0; x < row.width; x += static_cast<int>(hn::Lanes(d))) {
    const auto centre = hn::LoadU(d, row.pixels + x);
    auto sum = hn::Zero(d);
    auto weights = of_centre;
    for (const BilateralPair& pair : row.pairs) {
      const auto before = hn::Sub(hn::LoadU(d, pair.before + x), centre);
      const auto after = hn::Sub(hn::LoadU(d, pair.after + x), centre);
      const auto weight_before = weight_of(before);
      const auto weight_after = weight_of(after);
      const auto share = hn::Set(d, pair.weight);
      const auto differences = hn::Add(hn::MulFixedPoint15(weight_before, before),
                                       hn::MulFixedPoint15(weight_after, after));
      sum = hn::Add(sum, hn::MulFixedPoint15(differences, share));
      weights = hn::Add(weights, hn::MulFixedPoint15(hn::Add(weight_before, weight_after), share));
    }
    const auto lower = quotient(half, hn::LowerHalf(half, sum), hn::LowerHalf(half, weights));
    const auto upper = quotient(half, hn::UpperHalf(half, sum), hn::UpperHalf(half, weights));
    hn::StoreU(hn::Add(centre, hn::Combine(d, upper, lower)), d, row.output + x);
  }
}

void bilateral_steps(const float* grey_levels, int width, std::int16_t* steps) {
  const hn::CappedTag<float, kBilateralColumns> df;
  const hn::Rebind<std::int16_t, decltype(df)> d;
  const auto unit = hn::Set(df, static_cast<float>(kBilateralUnit));
  for (int x = 0; x < width; x += static_cast<int>(hn::Lanes(df))) {
    const auto level = hn::Max(hn::LoadU(df, grey_levels + x), hn::Zero(df));
    hn::StoreU(hn::DemoteTo(d, hn::NearestInt(hn::Mul(level, unit))), d, steps + x);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(bilateral);
HWY_EXPORT(bilateral_steps);

void bilateral_row(const BilateralRow& row) { HWY_DYNAMIC_DISPATCH(bilateral)(row); }
void bilateral_steps_row(const float* grey_levels, int width, std::int16_t* steps) {
  HWY_DYNAMIC_DISPATCH(bilateral_steps)(grey_levels, width, steps);
}

}  // namespace vantage::kernels
#endif
