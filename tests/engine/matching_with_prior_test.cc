// Matching with a prior: what it must not depend on, and what it does.

#include "engine/matching/stereo_matcher.h"
#include "engine/simd.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::matching_with_prior_test {

constexpr DisparityRange kRange{-3, 17};

/// Stripes: unknown, in the range with fractions, at its ends, outside.
DisparityMap striped_prior(int width, int height) {
  DisparityMap prior(width, height);
  const float values[] = {kUnknown, 3.25F, -3, 11.5F, 17, kUnknown, 25, 8.75F};
  for (const auto [x, y] : positions_of(width, height)) {
    prior.at(x, y) = values[(x / 5 + y / 7) % 8];
  }
  return prior;
}

DisparityMap constant_prior(int width, int height, float disparity_px) {
  DisparityMap prior(width, height);
  prior.fill(disparity_px);
  return prior;
}

DisparityMaps maps_with(const PhotographPair& pair, const MatchOptions& options,
                        const DisparityPrior& prior,
                        const ExecutionOptions& execution_options = {.threads = 2}) {
  return test::maps_of(pair, options, execution_options, {.confidence = true, .prior = prior});
}

class MatchingWithPrior : public ::testing::TestWithParam<MethodCase> {
 protected:
  MatchingWithPrior() : options_(GetParam().options) { options_.disparities = kRange; }
  MatchOptions options_;
};

TEST_P(MatchingWithPrior, PlansAndExecutorsGiveIdenticalResults) {
  using scheduler::ExecutorKind;
  const auto pair = textured_pair(49, 29, kRange, PixelKind::kColour8, 7);
  const DisparityMap map = striped_prior(49, 29);
  const DisparityPrior prior{.left_px = map.view(), .right_px = map.view(), .weight = 0.7};
  options_.parameters.subpixel = Subpixel::kParabola;
  const DisparityMaps expected =
      maps_with(pair, options_, prior, {.threads = 1, .executor = ExecutorKind::kSerial});
  EXPECT_FALSE(identical(maps_with(pair, options_, {}), expected));
  // The executors and the plans of method_execution_test hold for these stages, too: here strips
  // of a column, with bands, and passes.
  for (const ExecutionOptions& execution :
       {ExecutionOptions{
            .threads = 2, .strip_width_px = 1, .band_height_px = 9, .iterations_per_pass = 1},
        ExecutionOptions{
            .threads = 3, .strip_width_px = 23, .band_height_px = 500, .iterations_per_pass = 3},
        ExecutionOptions{.threads = 1,
        .strip_width_px = 500,
        .band_height_px = 9,
        .iterations_per_pass = 1000}}) {
    EXPECT_TRUE(identical(maps_with(pair, options_, prior, execution), expected))
        << "strip " << *execution.strip_width_px;
  }
}

TEST_P(MatchingWithPrior, InstructionSetsAgree) {
  const MethodParameters parameters = options_.resolved();
  if ((parameters.aggregation == Aggregation::kBayes &&
       parameters.prior_smoothing == PriorSmoothing::kSum) ||
      (parameters.aggregation == Aggregation::kLocalStopping &&
       parameters.certainty == Certainty::kEntropy)) {
    GTEST_SKIP() << "uses fused operations";
  }
  const auto pair = textured_pair(41, 19, kRange, PixelKind::kGrey8, 8);
  const DisparityMap map = striped_prior(41, 19);
  const DisparityPrior prior{.left_px = map.view(), .right_px = map.view()};
  DisparityMaps expected;
  for (const std::string& name : available_instruction_sets()) {
    force_instruction_set(name);
    DisparityMaps maps = maps_with(pair, options_, prior);
    if (expected.left.disparity_px.empty()) {
      expected = std::move(maps);
    } else {
      EXPECT_TRUE(identical(maps, expected)) << name;
    }
  }
  force_instruction_set("best");
}

TEST_P(MatchingWithPrior, NoPixelWithAPriorIsNoPrior) {
  const auto pair = textured_pair(37, 23, kRange, PixelKind::kGrey8, 9);
  const DisparityMaps expected = maps_with(pair, options_, {});
  for (const float nothing : {kUnknown, 18.0F, -3.5F}) {
    const DisparityMap map = constant_prior(37, 23, nothing);
    // Sums of costs in fractions are kept to another power of two.
    const DisparityMaps maps =
        maps_with(pair, options_, {.left_px = map.view(), .right_px = map.view(), .weight = 0.001});
    int equal = 0;
    for (const auto [x, y] : positions_of(37, 23)) {
      const float wanted = expected.left.disparity_px.at(x, y);
      const float actual = maps.left.disparity_px.at(x, y);
      equal += std::isnan(wanted) ? std::isnan(actual) : wanted == actual;
    }
    EXPECT_GE(equal, 37 * 23 - 1) << nothing;
  }
  const DisparityMap map = striped_prior(37, 23);
  EXPECT_TRUE(identical(
      maps_with(pair, options_, {.left_px = map.view(), .right_px = map.view(), .weight = 0}),
      expected));
}

TEST_P(MatchingWithPrior, DecidesWhereTheImagesDoNot) {
  PhotographPair flat;
  Image<std::uint8_t> grey(41, 19);
  grey.fill(90);
  flat.left.pixels = grey.copy();
  flat.right.pixels = std::move(grey);
  const DisparityMap map = constant_prior(41, 19, 5);
  const DisparityMaps maps =
      maps_with(flat, options_, {.left_px = map.view(), .right_px = map.view()});
  const bool has_likelihoods = options_.resolved().aggregation == Aggregation::kBayes;
  const DisparityMaps without = maps_with(flat, options_, {});
  for (int x = 12; x < 30; ++x) {
    const float actual = maps.left.disparity_px.at(x, 9);
    // Without any contrast a prior on energies has no unit; what rounding leaves will do.
    EXPECT_TRUE(actual == 5 || (!has_likelihoods && actual == without.left.disparity_px.at(x, 9)))
        << actual;
  }
}

TEST_P(MatchingWithPrior, GivesWayToTheImages) {
  // The prior is wrong everywhere by 6 pixels or more: what the images say wins nearly everywhere.
  const auto pair = textured_pair(61, 43, kRange, PixelKind::kGrey8, 10);
  options_.parameters.border = {};
  const DisparityMaps expected = maps_with(pair, options_, {});
  const DisparityMap map = constant_prior(61, 43, -3);
  const DisparityMaps maps =
      maps_with(pair, options_, {.left_px = map.view(), .right_px = map.view(), .weight = 0.25});
  int candidates = 0;
  int equal = 0;
  for (const auto [x, y] : positions_of({22, 50}, {5, 38})) {
    candidates += std::isnan(expected.left.disparity_px.at(x, y)) ? 0 : 1;
    equal += maps.left.disparity_px.at(x, y) == expected.left.disparity_px.at(x, y) ? 1 : 0;
  }
  EXPECT_GE(equal, 0.85 * candidates);
}

INSTANTIATE_TEST_SUITE_P(Methods, MatchingWithPrior, ::testing::ValuesIn(method_cases({})),
                         [](const auto& instance) { return instance.param.name; });

TEST(MatchingWithPriorErrors, AreNamed) {
  const auto pair = textured_pair(31, 17, {0, 9}, PixelKind::kGrey8, 1);
  MatchOptions options;
  options.disparities = {0, 9};
  const DisparityMap map = constant_prior(31, 17, 4);
  const DisparityMap narrow = constant_prior(30, 17, 4);
  EXPECT_THROW(maps_with(pair, options, {.left_px = map.view(), .weight = -1}), UsageError);
  EXPECT_THROW(maps_with(pair, options, {.left_px = map.view(), .weight = 101}), UsageError);
  EXPECT_THROW(maps_with(pair, options, {.left_px = map.view(), .weight = std::nan("")}),
               UsageError);
  EXPECT_THROW(maps_with(pair, options, {.right_px = narrow.view()}), Error);
  options.disparities_y = DisparityRange{-1, 1};
  EXPECT_THROW(maps_with(pair, options, {.left_px = map.view()}), UsageError);
}

TEST(MatchingWithPriorErrors, OneMapMayHaveNone) {
  const auto pair = textured_pair(31, 17, {0, 9}, PixelKind::kGrey8, 1);
  MatchOptions options;
  options.disparities = {0, 9};
  options.raw = true;
  const DisparityMap map = constant_prior(31, 17, 4);
  const DisparityMaps expected = maps_with(pair, options, {});
  const DisparityMaps maps = maps_with(pair, options, {.left_px = map.view(), .weight = 100});
  EXPECT_FALSE(identical(maps.left.disparity_px, expected.left.disparity_px));
  EXPECT_TRUE(identical(maps.right.disparity_px, expected.right.disparity_px));
}

}  // namespace vantage::matching_with_prior_test
