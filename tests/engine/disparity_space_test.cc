#include "engine/evaluation/disparity_space.h"

#include "engine/evaluation/method_comparison.h"
#include "engine/image/intensity_rows.h"
#include "tests/engine/engine_test.h"

namespace vantage::disparity_space_test {

BookPair small_pair() {
  ComparisonOptions options;
  options.size_px = 30;
  return make_book_pair(comparison_pair(options, "real-square", 1));
}

MatchOptions options_of(std::string_view method, int iterations) {
  return compared_options(compared_method(method), BookPattern::kGrass, iterations, {});
}

std::vector<float> grey_row(const Photograph& photograph, int y) {
  std::vector<float> row(static_cast<std::size_t>(photograph.width()));
  intensity_row(photograph, y, row.data());
  return row;
}

// (6.9) by hand on top of the engine's E0, which is (6.1).
TEST(DisparitySpace, HoldsTheMembranesEnergies) {
  const BookPair pair = small_pair();
  const auto space = [&](int iterations) {
    return disparity_space(pair, options_of("membrane", iterations), VolumeKind::kAggregated,
                           execution());
  };
  const DisparitySpace first = space(0);
  const DisparitySpace once = space(1);
  EXPECT_EQ(first.shape().content, VolumeContent::kEnergies);
  const int y = 12;
  const auto left = grey_row(pair.left, y);
  const auto right = grey_row(pair.right, y);
  for (int x = 10; x < 29; ++x) {
    for (int d = pair.search.min; d <= pair.search.max; ++d) {
      const double difference = double{left[static_cast<std::size_t>(x)]} -
                                double{right[static_cast<std::size_t>(x - d)]};
      const double here = double{first.at(x, y, d)};
      ASSERT_NEAR(here, difference * difference, 1e-3 * (1 + difference * difference));
      const double neighbours = double{first.at(x - 1, y, d)} + double{first.at(x, y - 1, d)} +
                                double{first.at(x, y + 1, d)} + double{first.at(x + 1, y, d)};
      if (x > 10) {
        ASSERT_NEAR(double{once.at(x, y, d)}, here + 0.15 * (neighbours - 4 * here),
                    1e-3 * (1 + here + neighbours));
      }
    }
  }
  EXPECT_TRUE(std::isnan(first.at(0, y, pair.search.max)));
}

TEST(DisparitySpace, TheFourStepsAreOneIterationOfTheEngine) {
  const BookPair pair = small_pair();
  const DisparitySpace costs =
      disparity_space(pair, options_of("bayes", 0), VolumeKind::kCosts, execution());
  for (const int iteration : {1, 4}) {
    const auto space = [&](int iterations) {
      return disparity_space(pair, options_of("bayes", iterations), VolumeKind::kAggregated,
                             execution());
    };
    const DisparitySpace before = space(iteration - 1);
    const DisparitySpace after = space(iteration);
    EXPECT_EQ(after.shape().content, VolumeContent::kProbabilities);
    for (const auto& [x, y] : {std::pair{11, 9}, {14, 15}, {27, 28}}) {
      const BayesSteps steps =
          bayes_steps(costs, before, options_of("bayes", iteration).resolved(), x, y);
      double sum = 0;
      for (int d = pair.search.min; d <= pair.search.max; ++d) {
        const double p = steps.probability[static_cast<std::size_t>(d - pair.search.min)];
        EXPECT_NEAR(double{after.at(x, y, d)}, p, 1e-4) << x << ' ' << y << ' ' << d;
        sum += p;
      }
      EXPECT_NEAR(sum, 1, 1e-12);
    }
  }
}

}  // namespace vantage::disparity_space_test
