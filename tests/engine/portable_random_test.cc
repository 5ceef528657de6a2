#include "engine/generation/portable_random.h"

#include "tests/engine/engine_test.h"

namespace vantage::portable_random_test {

TEST(PortableRandom, NormalNumbersHaveTheMomentsAndTailsOfANormalDistribution) {
  constexpr int kCount = 200000;
  PortableRandom random(3);
  double sums[5] = {};
  int beyond_two = 0;
  int beyond_three = 0;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    for (int power = 1; power <= 4; ++power) {
      sums[power] += std::pow(value, power);
    }
    beyond_two += std::abs(value) > 2 ? 1 : 0;
    beyond_three += std::abs(value) > 3 ? 1 : 0;
  }
  EXPECT_NEAR(sums[1] / kCount, 0, 0.01);
  EXPECT_NEAR(sums[2] / kCount, 1, 0.015);
  EXPECT_NEAR(sums[3] / kCount, 0, 0.03);
  EXPECT_NEAR(sums[4] / kCount, 3, 0.08);
  EXPECT_NEAR(beyond_two / static_cast<double>(kCount), std::erfc(2 / std::sqrt(2)), 0.002);
  EXPECT_NEAR(beyond_three / static_cast<double>(kCount), std::erfc(3 / std::sqrt(2)), 0.0005);
}

// The polar method once more, with the standard library's logarithm.
TEST(PortableRandom, NormalNumbersFollowThePolarMethod) {
  PortableRandom random(11, 4);
  PortableRandom uniforms(11, 4);
  for (int i = 0; i < 1000; ++i) {
    double u = 0;
    double v = 0;
    double square = 0;
    do {
      u = 2 * uniforms.uniform() - 1;
      v = 2 * uniforms.uniform() - 1;
      square = u * u + v * v;
    } while (square >= 1 || square == 0);
    const double factor = std::sqrt(-2 * std::log(square) / square);
    ASSERT_NEAR(random.normal(), u * factor, 1e-12);
    ASSERT_NEAR(random.normal(), v * factor, 1e-12);
  }
}

TEST(PortableRandom, SeedsAndStreamsDiffer) {
  EXPECT_EQ(PortableRandom(1, 2).uniform(), PortableRandom(1, 2).uniform());
  EXPECT_NE(PortableRandom(1, 2).uniform(), PortableRandom(1, 3).uniform());
  EXPECT_NE(PortableRandom(1, 2).uniform(), PortableRandom(2, 2).uniform());
  PortableRandom random(5);
  for (int i = 0; i < 1000; ++i) {
    const double value = random.uniform();
    ASSERT_GE(value, 0);
    ASSERT_LT(value, 1);
  }
}

}  // namespace vantage::portable_random_test
