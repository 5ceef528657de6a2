#include "engine/order_statistics.h"

#include "tests/engine/engine_test.h"

namespace vantage::order_statistics_test {

const std::vector<float> kValues = {7, -2, 7, 0, 3, 12, -2, 5};

TEST(OrderStatistics, AreThoseOfTheSortedValues) {
  std::vector<float> sorted = kValues;
  std::ranges::sort(sorted);
  for (std::size_t rank = 0; rank < sorted.size(); ++rank) {
    EXPECT_EQ(value_of_rank(std::vector(kValues), rank), sorted[rank]);
  }
  EXPECT_EQ(upper_median(std::vector(kValues)), 5);  // of 3 and 5
  EXPECT_EQ(upper_median(std::vector{2, 9, 4}), 4);
  EXPECT_EQ(upper_median(std::vector{1.5}), 1.5);
}

TEST(OrderStatistics, PercentilesHaveTheNearestRank) {
  EXPECT_EQ(percentile(std::vector(kValues), 0), -2);
  EXPECT_EQ(percentile(std::vector(kValues), 0.2), -2);   // rank 1.4
  EXPECT_EQ(percentile(std::vector(kValues), 0.22), 0);   // 1.54
  EXPECT_EQ(percentile(std::vector(kValues), 0.93), 12);  // 6.51
  EXPECT_EQ(percentile(std::vector(kValues), 1), 12);
}

}  // namespace vantage::order_statistics_test
