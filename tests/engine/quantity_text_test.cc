#include "engine/profiling/quantity_text.h"

#include "tests/engine/engine_test.h"

namespace vantage::quantity_text_test {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(QuantityText, HasThreeDigitsAndAPrefix) {
  EXPECT_EQ(quantity_text(0, "s"), "0\u00A0s");
  EXPECT_EQ(quantity_text(0.00124, "s"), "1.24\u00A0ms");
  EXPECT_EQ(quantity_text(12.345, "s"), "12.3\u00A0s");
  EXPECT_EQ(quantity_text(999.6e-6, "s"), "1.00\u00A0ms");
  EXPECT_EQ(quantity_text(0.5e-6, "s"), "500\u00A0ns");
  EXPECT_EQ(quantity_text(81'698'816, "B"), "81.7\u00A0MB");
  EXPECT_EQ(quantity_text(-2.5e9, ""), "-2.50\u00A0G");
  EXPECT_EQ(quantity_text(5e-13, "s"), "0.000500\u00A0ns");
}

TEST(QuantityText, RangesAreInTheMediansUnit) {
  EXPECT_EQ(sample_text({0.9e-3, 0.8e-3, 1.2e-3}, "s"), "900\u00A0(800–1200)\u00A0µs");
  EXPECT_EQ(sample_text({2, 2, 2}, "s"), "2.00\u00A0s");
}

TEST(QuantityText, SharesArePercents) {
  EXPECT_EQ(percent_text(0), "0\u00A0%");
  EXPECT_EQ(percent_text(0.43), "43\u00A0%");
  EXPECT_EQ(percent_text(0.0432), "4.3\u00A0%");
  EXPECT_EQ(percent_text(0.00432), "0.43\u00A0%");
  EXPECT_EQ(percent_text(-0.02), "-2.0\u00A0%");
}

TEST(QuantityText, WhatIsNotFiniteIsADash) {
  EXPECT_EQ(quantity_text(kNaN, "s"), "–");
  EXPECT_EQ(quantity_text(kInfinity, "s"), "–");
  EXPECT_EQ(number_text(kNaN), "–");
  EXPECT_EQ(percent_text(-kInfinity), "–");
  EXPECT_EQ(sample_text({kNaN, 1, 2}, "s"), "–");
}

}  // namespace vantage::quantity_text_test
