#include "kernels/simd-inl.h"

#include <cstddef>

#include "kernels/bilateral/bilateral.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

void bilateral(const BilateralRow& row) {
  const hn::CappedTag<float, kBilateralColumns> df;
  const int step = static_cast<int>(hn::Lanes(df));
  const auto per_cut_off = hn::Set(df, 1 / row.cut_off);
  const auto one = hn::Set(df, 1.0F);
  const auto zero = hn::Zero(df);
  for (int x = 0; x < row.width; x += step) {
    const auto centre = hn::LoadU(df, row.rows[kBilateralRadius] + x);
    auto sum = zero;
    auto weights = zero;
    for (std::size_t v = 0; v < kBilateralSide; ++v) {
      for (std::size_t u = 0; u < kBilateralSide; ++u) {
        const float* pixels = row.rows[v] + x - kBilateralRadius + u;
        const auto difference = hn::Sub(hn::LoadU(df, pixels), centre);
        const auto share = hn::Mul(difference, per_cut_off);
        const auto root = hn::Max(zero, hn::Sub(one, hn::Mul(share, share)));
        const auto weight = hn::Mul(hn::Mul(root, root), hn::Set(df, row.weights[v][u]));
        sum = hn::Add(sum, hn::Mul(weight, difference));
        weights = hn::Add(weights, weight);
      }
    }
    hn::StoreU(hn::Add(centre, hn::Div(sum, weights)), df, row.output + x);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(bilateral);

void bilateral_row(const BilateralRow& row) { HWY_DYNAMIC_DISPATCH(bilateral)(row); }

}  // namespace vantage::kernels
#endif
