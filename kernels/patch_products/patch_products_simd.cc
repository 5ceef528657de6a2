#include "kernels/simd-inl.h"

#include "kernels/patch_products/patch_products.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

void patch_products(const PatchProducts& task, int count, float* HWY_RESTRICT sums) {
  const hn::CappedTag<float, kPatchPlaces> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (int first = 0; first < count; first += kPatchPlaces) {
    // Two vectors at a time hide the latency of their additions.
    for (int c = first; c < first + kPatchPlaces; c += 2 * lanes) {
      const bool has_second = lanes < kPatchPlaces;
      auto sum = hn::Zero(d);
      auto second = hn::Zero(d);
      const float* value = task.patch;
      for (int row = 0; row < task.rows; ++row) {
        const float* const other = task.other + row * task.stride + c;
        for (int column = 0; column < task.columns; ++column, ++value) {
          const auto factor = hn::Set(d, *value);
          sum = hn::Add(sum, hn::Mul(factor, hn::LoadU(d, other + column)));
          if (has_second) {
            second = hn::Add(second, hn::Mul(factor, hn::LoadU(d, other + column + lanes)));
          }
        }
      }
      hn::StoreU(sum, d, sums + c);
      if (has_second) {
        hn::StoreU(second, d, sums + c + lanes);
      }
    }
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(patch_products);

void patch_products(const PatchProducts& task, int count, float* sums) {
  HWY_DYNAMIC_DISPATCH(patch_products)(task, count, sums);
}

}  // namespace vantage::kernels
#endif
