#include "kernels/machine_ceiling/machine_ceiling.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::machine_ceiling_test {

VANTAGE_ON_EVERY_TARGET(MachineCeiling);

TEST_P(MachineCeiling, TriadAndLoadsDoWhatTheyAreCountedAs) {
  for (const std::size_t count : {0UL, 1UL, 7UL, 64UL, 131UL, 1000UL}) {
    std::vector<float> a(count + 1, -1);
    std::vector<float> b(count);
    std::vector<float> c(count);
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      b[i] = static_cast<float>(i);
      c[i] = static_cast<float>(2 * i);
      sum += static_cast<double>(b[i]);
    }
    triad(a.data(), b.data(), c.data(), 0.5F, count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(a[i], static_cast<float>(2 * i));
    }
    EXPECT_EQ(a[count], -1) << "written behind the end";
    EXPECT_EQ(load_all(b.data(), count), static_cast<float>(sum));
  }
}

TEST_P(MachineCeiling, ArithmeticIsInProportionToRoundsAndIsDone) {
  float sink = 0;
  const double operations = multiply_and_add(3, sink);
  EXPECT_GT(operations, 0);
  EXPECT_EQ(multiply_and_add(9, sink), 3 * operations);
  // All chains of x ← 0.999 x + 0.001 end at 1: the sink is the number of chains and lanes.
  const double lanes_and_chains = operations / (2 * 3 * 16);
  multiply_and_add(5000, sink);
  EXPECT_NEAR(sink, lanes_and_chains, 0.01 * lanes_and_chains);
}

}  // namespace vantage::kernels::machine_ceiling_test
