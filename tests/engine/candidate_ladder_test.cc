#include "engine/tuning/candidate_ladder.h"

#include "tests/engine/engine_test.h"

namespace vantage::candidate_ladder_test {

TEST(CoarseLadder, ReachesFromOneToTheMost) {
  EXPECT_THAT(coarse_ladder(1), ElementsAre(1));
  EXPECT_THAT(coarse_ladder(0), ElementsAre(1));
  EXPECT_THAT(coarse_ladder(2), ElementsAre(1, 2));
  EXPECT_THAT(coarse_ladder(10), ElementsAre(1, 2, 3, 4, 6, 9, 10));
}

TEST(FineLadder, IsAroundTheValueWithinTheRange) {
  EXPECT_THAT(fine_ladder(12, 100), ElementsAre(8, 10, 11, 13, 14, 16));
  EXPECT_THAT(fine_ladder(12, 13), ElementsAre(8, 10, 11, 13));
  EXPECT_THAT(fine_ladder(1, 2), ElementsAre(2));
  EXPECT_THAT(fine_ladder(1, 1), IsEmpty());
  EXPECT_THAT(fine_ladder(7, 1000), Each(Not(7)));
}

}  // namespace vantage::candidate_ladder_test
