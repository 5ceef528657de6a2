#include "kernels/known_range/known_range.h"

#include "tests/kernels/synthesis_rows.h"

namespace vantage::kernels::known_range_test {

TEST(KnownRange, LeastAndMostOfWhatIsKnown) {
  std::mt19937 random(1);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const int width : kAwkwardWidths) {
    for (const int unknown : {0, 1, 2, 8}) {
      std::vector<float> row = random_disparities(random, width, -30, 50);
      for (float& d : row) {
        if (static_cast<int>(random() % 8) < unknown) {
          d = random() % 2 == 0 ? kInfinity : -kInfinity;
        }
      }
      for (const KnownRange& given : {KnownRange{}, KnownRange{-3, 4}}) {
        const KnownRange expected = known_range_row_ref(row.data(), width, given);
        KnownRange plain = given;
        for (const float d : row) {
          if (d > -1e30F && d < 1e30F) {
            plain.min = d < plain.min ? d : plain.min;
            plain.max = d > plain.max ? d : plain.max;
          }
        }
        ASSERT_EQ(expected.min, plain.min);
        ASSERT_EQ(expected.max, plain.max);
        for_each_target([&] {
          const KnownRange range = known_range_row(row.data(), width, given);
          ASSERT_EQ(range.min, expected.min);
          ASSERT_EQ(range.max, expected.max);
        });
      }
    }
  }
}

TEST(KnownRange, NothingIsKnown) {
  const KnownRange range = known_range_row(nullptr, 0, {});
  EXPECT_GT(range.min, range.max);
}

}  // namespace vantage::kernels::known_range_test
