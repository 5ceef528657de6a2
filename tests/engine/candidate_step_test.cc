// Candidates between pixels, of every method, against the plain transcription.

#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::candidate_step_test {

class CandidateStep : public ::testing::TestWithParam<MethodCase> {};

TEST_P(CandidateStep, EqualsTheOracle) {
  if (is_stepped(GetParam()) && GetParam().options.resolved().levels == 1) {
    GTEST_SKIP() << "cells are rounded to steps: see stage_cost_test";
  }
  struct Shape {
    int width;
    int height;
    DisparityRange range;
    double step_px;
  };
  Execution execution({.threads = 2, .strip_width_px = 17, .band_height_px = 5});
  for (const Shape& shape :
       {Shape{47, 29, {-2, 9}, 0.5}, Shape{43, 21, {1, 6}, 0.25}, Shape{1, 3, {-1, 2}, 0.5},
        Shape{9, 12, {-12, 12}, 0.25}, Shape{2, 1, {0, 0}, 0.5}}) {
    const bool is_small = shape.width < 20;
    const auto pair = textured_pair(shape.width, shape.height, shape.range, PixelKind::kGrey8, 6);
    MatchOptions options = GetParam().options;
    options.disparities = shape.range;
    options.parameters.candidate_step_px = shape.step_px;
    options.parameters.subpixel = shape.range.min < 0 ? Subpixel::kParabola : Subpixel::kNone;
    if (is_small && options.resolved().border == Border::kValid) {
      continue;
    }
    Tolerance tolerance = tolerance_of(options.resolved());
    if (options.resolved().levels > 1) {  // stored levels are rounded, see coarse_to_fine_test
      tolerance.share = 0.9;
      tolerance.confidence_share = 0;
    }
    tolerance.strays = is_small ? 5 : 0;
    expect_equals_oracle(pair, options, execution, tolerance,
                         GetParam().name + ", width " + std::to_string(shape.width));
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, CandidateStep, ::testing::ValuesIn(method_cases({0, 1})),
                         [](const auto& instance) { return instance.param.name; });

TEST(CandidateSteps, AreRefusedWhereTheyHaveNoMeaning) {
  MatchOptions options;
  options.disparities = {0, 2000};
  options.parameters.candidate_step_px = 0.3;
  EXPECT_THROW(options.validate(), UsageError);
  options.parameters.candidate_step_px = 0.25;
  EXPECT_THROW(options.validate(), UsageError);  // 8001 candidates
  options.disparities = {0, 20};
  EXPECT_NO_THROW(options.validate());
  options.disparities_y = DisparityRange{-1, 1};
  EXPECT_THROW(options.validate(), UsageError);
  options.disparities_y.reset();
  options.preset = MatchPreset::kRealtime;
  EXPECT_NO_THROW(options.validate());
  EXPECT_EQ(options.resolved().search_size, SearchSize::kFull);
  options.parameters.search_size = SearchSize::kHalf;
  EXPECT_THROW(options.validate(), UsageError);
}

}  // namespace vantage::candidate_step_test
