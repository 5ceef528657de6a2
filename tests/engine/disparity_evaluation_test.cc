#include "engine/evaluation/disparity_evaluation.h"

#include "tests/engine/engine_test.h"

namespace vantage::disparity_evaluation_test {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

DisparityMap row_of(const std::vector<float>& values) {
  DisparityMap map(static_cast<int>(values.size()), 1);
  std::copy(values.begin(), values.end(), map.row(0));
  return map;
}

TEST(DisparityEvaluation, CountsThresholdsStrictlyAndInvalidAsBad) {
  // Errors 0, 0.5, 1, 1.5, 3, 5, two invalid, two without truth.
  const DisparityMap truth = row_of({10, 10, 10, 10, 10, 10, 10, 10, kNan, kInf});
  const DisparityMap map = row_of({10, 10.5F, 9, 11.5F, 13, 5, kNan, -kInf, 10, 99});
  const DisparityScores scores = evaluate_disparity(map.view(), truth.view());
  EXPECT_EQ(scores.evaluated_pixels, 8);
  EXPECT_EQ(scores.valid_pixels, 6);
  EXPECT_DOUBLE_EQ(scores.coverage_percent, 75);
  EXPECT_DOUBLE_EQ(scores.bad_0_5_percent, 100.0 * 6 / 8);
  EXPECT_DOUBLE_EQ(scores.bad_1_percent, 100.0 * 5 / 8);
  EXPECT_DOUBLE_EQ(scores.bad_2_percent, 100.0 * 4 / 8);
  EXPECT_DOUBLE_EQ(scores.bad_4_percent, 100.0 * 3 / 8);
  EXPECT_DOUBLE_EQ(scores.average_px, 11.0 / 6);
  EXPECT_DOUBLE_EQ(scores.rms_px, std::sqrt((0.25 + 1 + 2.25 + 9 + 25) / 6));
  EXPECT_DOUBLE_EQ(scores.a50_px, 1);
  EXPECT_DOUBLE_EQ(scores.a90_px, 5);
}

// The smallest error that at least `percent` of all errors do not exceed, by trying them all.
double plain_quantile(const std::vector<double>& errors, int percent) {
  double best = std::numeric_limits<double>::infinity();
  for (const double candidate : errors) {
    const auto covered = std::count_if(errors.begin(), errors.end(),
                                       [&](double error) { return error <= candidate; });
    if (100 * covered >= percent * static_cast<long>(errors.size())) {
      best = std::min(best, candidate);
    }
  }
  return best;
}

TEST(DisparityEvaluation, AgreesWithPlainTranscriptionOnRandomMaps) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> level(0, 12);
  std::uniform_int_distribution<int> die(0, 9);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {31, 17}, {64, 5}}) {
    for (const int border : {0, 1, 2}) {
      DisparityMap map(width, height);
      DisparityMap truth(width, height);
      Mask mask(width, height);
      std::vector<double> errors;
      long evaluated = 0;
      for (const auto [x, y] : positions_of(width, height)) {
        map.at(x, y) = die(random) == 0 ? kNan : level(random);
        truth.at(x, y) = die(random) == 0 ? kInf : level(random);
        mask.at(x, y) = static_cast<std::uint8_t>(die(random) < 7 ? 255 : die(random));
        const bool inside = x >= border && y >= border && x + border < width && y + border < height;
        if (inside && mask.at(x, y) == 255 && std::isfinite(truth.at(x, y))) {
          ++evaluated;
          if (std::isfinite(map.at(x, y))) {
            errors.push_back(std::abs(static_cast<double>(map.at(x, y)) - truth.at(x, y)));
          }
        }
      }
      const DisparityEvaluationOptions options{.mask = mask.view(), .ignore_border_px = border};
      if (evaluated == 0) {
        EXPECT_THROW((void)evaluate_disparity(map.view(), truth.view(), options), Error);
        continue;
      }
      const DisparityScores scores = evaluate_disparity(map.view(), truth.view(), options);
      EXPECT_EQ(scores.evaluated_pixels, evaluated);
      ASSERT_EQ(scores.valid_pixels, static_cast<long>(errors.size()));
      if (errors.empty()) {
        continue;
      }
      EXPECT_EQ(scores.a50_px, plain_quantile(errors, 50));
      EXPECT_EQ(scores.a90_px, plain_quantile(errors, 90));
      EXPECT_EQ(scores.a95_px, plain_quantile(errors, 95));
      EXPECT_EQ(scores.a99_px, plain_quantile(errors, 99));
      const auto far_off =
          std::count_if(errors.begin(), errors.end(), [](double error) { return error > 2; });
      EXPECT_NEAR(scores.bad_2_percent,
                  100.0 * static_cast<double>(far_off + evaluated - scores.valid_pixels) /
                      static_cast<double>(evaluated),
                  1e-9);
    }
  }
}

TEST(DisparityEvaluation, PerfectMapScoresZero) {
  const DisparityMap truth = row_of({1, 2, 3.25F});
  const DisparityScores scores = evaluate_disparity(truth.view(), truth.view());
  EXPECT_EQ(scores.bad_0_5_percent, 0);
  EXPECT_EQ(scores.average_px, 0);
  EXPECT_EQ(scores.a99_px, 0);
  EXPECT_EQ(scores.coverage_percent, 100);
}

TEST(DisparityEvaluation, EmptyMapIsAllBadWithUnknownErrors) {
  const DisparityScores scores =
      evaluate_disparity(row_of({kNan, kInf}).view(), row_of({1, 2}).view());
  EXPECT_EQ(scores.bad_4_percent, 100);
  EXPECT_EQ(scores.coverage_percent, 0);
  EXPECT_TRUE(std::isnan(scores.average_px));
  EXPECT_TRUE(std::isnan(scores.rms_px));
  EXPECT_TRUE(std::isnan(scores.a50_px));
}

TEST(DisparityEvaluation, RejectsWhatCannotBeCompared) {
  const DisparityMap two = row_of({1, 2});
  const DisparityMap three = row_of({1, 2, 3});
  const DisparityMap unknown = row_of({kNan, kNan});
  const Mask mask(3, 1);
  EXPECT_THROW((void)evaluate_disparity(three.view(), two.view()), Error);
  EXPECT_THROW((void)evaluate_disparity(two.view(), two.view(), {.mask = mask.view()}), Error);
  EXPECT_THROW((void)evaluate_disparity(two.view(), unknown.view()), Error);
  EXPECT_THROW((void)evaluate_disparity(two.view(), two.view(), {.ignore_border_px = 1}), Error);
  EXPECT_THROW((void)evaluate_disparity(two.view(), two.view(), {.ignore_border_px = -1}),
               UsageError);
  EXPECT_THROW((void)evaluate_disparity(two.view(), two.view(), {.ignore_border_px = 2147483647}),
               Error);
}

}  // namespace vantage::disparity_evaluation_test
