#include "kernels/patch_products/patch_products.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::patch_products_test {

VANTAGE_ON_EVERY_TARGET(PatchProducts);

TEST_P(PatchProducts, AreSumsOverThePatch) {
  std::mt19937 random(31);
  std::uniform_real_distribution<float> value(-100, 100);
  constexpr int kRows = 3;
  constexpr int kColumns = 7;
  for (const int count : {1, 15, 16, 17, 40}) {
    const int places = (count + kPatchPlaces - 1) / kPatchPlaces * kPatchPlaces;
    const int stride = places + kColumns + 2;
    std::vector<float> patch(kRows * kColumns);
    std::vector<float> other(static_cast<std::size_t>(kRows * stride));
    std::generate(patch.begin(), patch.end(), [&] { return value(random); });
    std::generate(other.begin(), other.end(), [&] { return value(random); });
    std::vector<float> sums(static_cast<std::size_t>(places));
    patch_products({patch.data(), kRows, kColumns, other.data(), stride}, count, sums.data());
    for (int c = 0; c < count; ++c) {
      float expected = 0;
      for (int k = 0; k < kRows * kColumns; ++k) {
        const int at = k / kColumns * stride + k % kColumns + c;
        expected += patch[static_cast<std::size_t>(k)] * other[static_cast<std::size_t>(at)];
      }
      ASSERT_EQ(sums[static_cast<std::size_t>(c)], expected) << count << ", " << c;
    }
  }
}

}  // namespace vantage::kernels::patch_products_test
