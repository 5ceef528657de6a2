// Parameters of the methods, and images of awkward shape, against the plain transcription.

#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::method_variants_test {

struct Variant {
  const char* name;
  MatchMethod method;
  MethodOverrides parameters;
};

void PrintTo(const Variant& variant, std::ostream* stream) { *stream << variant.name; }

class MethodVariants : public ::testing::TestWithParam<Variant> {};

TEST_P(MethodVariants, EqualTheOracle) {
  const DisparityRange range{-3, 17};
  const auto pair = textured_pair(53, 37, range, PixelKind::kGrey8, 4);
  MatchOptions options;
  options.method = GetParam().method;
  options.disparities = range;
  options.parameters = GetParam().parameters;
  expect_equals_oracle(pair, options, execution(), tolerance_of(options.resolved()),
                       GetParam().name);
}

using enum MatchMethod;

const Variant kVariants[] = {
    {"sobel", kGradient, {.gradient = GradientFilter::kSobel}},
    {"simoncelli3", kGradient, {.gradient = GradientFilter::kSimoncelli3}},
    {"simoncelli5", kGradient, {.gradient = GradientFilter::kSimoncelli5}},
    {"octagon", kGradient, {.norm = GradientNorm::kOctagon}},
    {"l1", kGradient, {.norm = GradientNorm::kL1}},
    {"l_max", kGradient, {.norm = GradientNorm::kMax}},
    {"forward", kGradient, {.gradient = GradientFilter::kForward}},
    {"x_gradients", kGradient, {.gradient_components = GradientComponents::kX}},
    {"raw_gradients", kGradient, {.prefilter = false}},
    {"alpha", kGradient, {.alpha = 0.4}},
    {"narrow_cascade", kGradient, {.aggregation_sigma_px = 0.5}},
    {"odd_cascade", kGradient, {.aggregation_sigma_px = 2.7}},
    {"wide_cascade", kGradient, {.aggregation_sigma_px = 9.3}},
    {"gaussian", kGradient, {.aggregation = Aggregation::kGaussian, .aggregation_sigma_px = 3.3}},
    {"no_iterations", kDiffusion, {.iterations = 0}},
    {"one_iteration", kMembrane, {.iterations = 1}},
    {"fifty_iterations", kMembrane, {.iterations = 50}},
    {"steps", kDiffusion, {.iterations = 25, .lambda = 0.24}},
    {"largest_step", kMembrane, {.lambda = 0.2, .beta = 1}},
    {"no_pull", kMembrane, {.beta = 0}},
    {"stopping_once", kLocalStopping, {.iterations = 1}},
    {"stopping_never_begun", kLocalStopping, {.iterations = 0}},
    {"stopping_thirty", kLocalStopping, {.iterations = 30}},
    {"sure_entropy", kLocalStopping, {.certainty = Certainty::kEntropy}},
    {"entropy", kLocalStopping, {.sigma_measurement = 20, .certainty = Certainty::kEntropy}},
    {"prior_only_at_start", kBayes, {.iterations = 0}},
    {"once", kBayes, {.iterations = 1}},
    {"fifty", kBayes, {.iterations = 50}},
    {"planar", kBayes, {.sigma_measurement = 2, .sigma_prior = 0.1}},
    {"two_taps", kBayes, {.sigma_prior = 0.7}},
    {"wide_prior", kBayes, {.sigma_prior = 3}},
    {"endless_prior", kBayes, {.sigma_prior = 200}},
    {"mu_small", kBayes, {.mu = 0.1}},
    {"mu_one", kBayes, {.sigma_measurement = 20, .mu = 1}},
    {"mu_other_wide", kBayes, {.iterations = 20, .mu = 0.45, .sigma_prior = 1.5}},
    {"sure_prior", kBayes, {.epsilon_prior = 1e-6}},
    {"surest_prior", kBayes, {.epsilon_prior = 1e-9}},
    {"impulse", kBayes, {.prior = Prior::kImpulse}},
    {"impulse_maximum",
     kBayes,
     {.iterations = 5, .prior = Prior::kImpulse, .prior_smoothing = PriorSmoothing::kMaximum}},
    {"quadratic", kBayes, {.prior = Prior::kQuadratic}},
    {"quadratic_maximum",
     kBayes,
     {.prior = Prior::kQuadratic, .prior_smoothing = PriorSmoothing::kMaximum}},
    {"quadratic_wide", kBayes, {.mu = 0.3, .prior = Prior::kQuadratic, .sigma_prior = 6}},
    {"quadratic_narrow", kBayes, {.prior = Prior::kQuadratic, .sigma_prior = 0.2}},
    {"unsure", kBayes, {.epsilon_measurement = 0.6, .epsilon_prior = 0.4}},
    {"sure_measurement", kBayes, {.epsilon_measurement = 1e-5}},
};

INSTANTIATE_TEST_SUITE_P(OfEveryMethod, MethodVariants, ::testing::ValuesIn(kVariants),
                         [](const auto& instance) { return std::string(instance.param.name); });

class AwkwardShapes : public ::testing::TestWithParam<MethodCase> {};

TEST_P(AwkwardShapes, EqualTheOracle) {
  if (is_stepped(GetParam())) {
    GTEST_SKIP() << "cells are rounded to steps: see stage_cost_test, coarse_to_fine_test";
  }
  struct Shape {
    int width;
    int height;
    DisparityRange range;
  };
  Execution execution({.threads = 2, .strip_width_px = 7, .band_height_px = 5});
  for (const Shape& shape :
       {Shape{1, 1, {0, 0}}, Shape{1, 1, {-2, 3}}, Shape{1, 19, {-1, 4}}, Shape{29, 1, {0, 15}},
        Shape{2, 2, {0, 1}}, Shape{16, 16, {0, 15}}, Shape{17, 13, {0, 16}},
        Shape{13, 11, {-30, 30}}, Shape{33, 9, {20, 40}}, Shape{31, 8, {-29, -3}},
        Shape{48, 5, {5, 5}}, Shape{11, 23, {0, 40}}}) {
    const std::string name = std::to_string(shape.width) + " x " + std::to_string(shape.height) +
                             ", range from " + std::to_string(shape.range.min);
    const auto pair = textured_pair(shape.width, shape.height, shape.range, PixelKind::kGrey8, 5);
    MatchOptions options = GetParam().options;
    options.disparities = shape.range;
    const int window = options.resolved().window_px;
    if (options.resolved().border == Border::kValid &&
        (shape.width < window || shape.height < window || shape.range.min > shape.width - window)) {
      DisparityMaps maps;
      EXPECT_THROW(StereoMatcher(options, execution).match(pair.left, pair.right, {}, maps), Error)
          << name;
      continue;
    }
    Tolerance tolerance = tolerance_of(options.resolved());
    if (options.resolved().aggregation == Aggregation::kLocalStopping) {
      tolerance.strays = 5;  // an eleventh of such small images lies beside a stray pixel
    }
    expect_equals_oracle(pair, options, execution, tolerance, name);
  }
}

/// No texture: every candidate is as good, the smallest disparity with a partner wins. Under
/// Bayesian diffusion not quite: candidates beside others that are likely are more likely.
TEST_P(AwkwardShapes, ConstantImagesTakeTheSmallestDisparity) {
  Image<std::uint8_t> left(23, 12);
  Image<std::uint8_t> right(23, 12);
  left.fill(77);
  right.fill(77);
  const PhotographPair pair{{std::move(left)}, {std::move(right)}};
  MatchOptions options = GetParam().options;
  options.disparities = {-4, 9};
  expect_equals_oracle(pair, options, execution(), tolerance_of(options.resolved()), "constant");
  if (options.resolved().aggregation == Aggregation::kBayes) {
    return;
  }
  DisparityMaps maps;
  StereoMatcher(options, execution()).match(pair.left, pair.right, {}, maps);
  const int margin =
      options.resolved().border == Border::kValid ? options.resolved().window_px / 2 : 0;
  for (const auto [x, y] : positions_of({margin, 23 - margin}, {margin, 12 - margin})) {
    EXPECT_EQ(maps.left.disparity_px.at(x, y), std::max(-4, x - 22 + margin)) << x << ", " << y;
    EXPECT_EQ(maps.right.disparity_px.at(x, y), std::max(-4, -x + margin)) << x << ", " << y;
  }
}

TEST_P(AwkwardShapes, RangesWithoutAnyCandidateAreRefused) {
  const auto pair = textured_pair(20, 10, {0, 5}, PixelKind::kGrey8, 6);
  MatchOptions options = GetParam().options;
  for (const DisparityRange range : {DisparityRange{20, 30}, DisparityRange{-60, -20}}) {
    options.disparities = range;
    DisparityMaps maps;
    EXPECT_THROW(StereoMatcher(options, execution()).match(pair.left, pair.right, {}, maps), Error);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, AwkwardShapes, ::testing::ValuesIn(method_cases({})),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace vantage::method_variants_test
