#include "engine/matching/aggregation/stage_column_sum.h"

#include "tests/engine/engine_test.h"

namespace vantage::stage_column_sum_test {

TEST(ColumnSumScale, LeavesRoomForTheSumOfAWindow) {
  for (const int window_px : {1, 3, 9, 21, 101, 181}) {
    for (const auto& [min, largest] : {std::pair{0.0F, 65025.0F},
                                       {-140.0F, 140.0F},
                                       {0.0F, 1e-3F},
                                       {3.0F, 3.5F},
                                       {-1e6F, 1e6F},
                                       {0.0F, 63.0F},
                                       {0.0F, 1e-40F}}) {
      SCOPED_TRACE(::testing::Message() << min << " to " << largest << ", window " << window_px);
      const ColumnSumScale scale = column_sum_scale(min, largest, window_px);
      EXPECT_EQ(min + scale.offset, 0);
      int exponent = 0;
      EXPECT_EQ(std::frexp(scale.scale, &exponent), 0.5) << "not a power of two";
      const auto fits = [&](double factor) {
        const double max = std::round((static_cast<double>(largest) - min) * factor);
        return max < 4194304 && max * window_px * window_px < 2147483647.0;
      };
      EXPECT_TRUE(fits(scale.scale));
      EXPECT_TRUE(scale.scale > 1e30F || !fits(2.1 * scale.scale)) << scale.scale;
    }
  }
}

TEST(ColumnSumScale, TakesCostsThatAreAllAlike) {
  const ColumnSumScale scale = column_sum_scale(5, 5, 9);
  EXPECT_EQ(scale.offset, -5);
  EXPECT_EQ(scale.scale, 1);
}

}  // namespace vantage::stage_column_sum_test
