// Parameters of the methods, and images of awkward shape, against the plain transcription.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

#include "engine/error.h"
#include "engine/matching/stereo_matcher.h"
#include "tests/engine/method_cases.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage {
namespace method_variants_test {

using test::expect_equals_oracle;
using test::method_cases;
using test::MethodCase;
using test::PhotographPair;
using test::PixelKind;
using test::textured_pair;
using test::tolerance_of;

struct Variant {
  const char* name;
  MatchMethod method;
  void (*set)(MethodOverrides& p);
};

void PrintTo(const Variant& variant, std::ostream* stream) { *stream << variant.name; }

std::string name_of(const ::testing::TestParamInfo<Variant>& instance) {
  return instance.param.name;
}

class MethodVariants : public ::testing::TestWithParam<Variant> {};

TEST_P(MethodVariants, EqualTheOracle) {
  const DisparityRange range{-3, 17};
  const auto pair = textured_pair(53, 37, range, PixelKind::kGrey8, 4);
  MatchOptions options;
  options.method = GetParam().method;
  options.disparities = range;
  GetParam().set(options.parameters);
  Execution execution({.threads = 2});
  expect_equals_oracle(pair, options, execution, tolerance_of(options.resolved()), GetParam().name);
}

// p: the parameters of a variant.
constexpr MatchMethod kGradient = MatchMethod::kGradient;
constexpr MatchMethod kBayes = MatchMethod::kBayes;

INSTANTIATE_TEST_SUITE_P(
    Gradient, MethodVariants,
    ::testing::Values(
        Variant{"sobel", kGradient,
                [](MethodOverrides& p) { p.gradient = GradientFilter::kSobel; }},
        Variant{"simoncelli3", kGradient,
                [](MethodOverrides& p) { p.gradient = GradientFilter::kSimoncelli3; }},
        Variant{"simoncelli5", kGradient,
                [](MethodOverrides& p) { p.gradient = GradientFilter::kSimoncelli5; }},
        Variant{"octagon", kGradient, [](MethodOverrides& p) { p.norm = GradientNorm::kOctagon; }},
        Variant{"l1", kGradient, [](MethodOverrides& p) { p.norm = GradientNorm::kL1; }},
        Variant{"l_max", kGradient, [](MethodOverrides& p) { p.norm = GradientNorm::kMax; }},
        Variant{"forward", kGradient,
                [](MethodOverrides& p) { p.gradient = GradientFilter::kForward; }},
        Variant{"x_gradients", kGradient,
                [](MethodOverrides& p) { p.gradient_components = GradientComponents::kX; }},
        Variant{"raw_gradients", kGradient, [](MethodOverrides& p) { p.prefilter = false; }},
        Variant{"alpha", kGradient, [](MethodOverrides& p) { p.alpha = 0.4; }},
        Variant{"narrow_cascade", kGradient,
                [](MethodOverrides& p) { p.aggregation_sigma_px = 0.5; }},
        Variant{"odd_cascade", kGradient, [](MethodOverrides& p) { p.aggregation_sigma_px = 2.7; }},
        Variant{"wide_cascade", kGradient,
                [](MethodOverrides& p) { p.aggregation_sigma_px = 9.3; }},
        Variant{"gaussian", kGradient,
                [](MethodOverrides& p) {
                  p.aggregation = Aggregation::kGaussian;
                  p.aggregation_sigma_px = 3.3;
                }}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Diffusion, MethodVariants,
    ::testing::Values(Variant{"no_iterations", MatchMethod::kDiffusion,
                              [](MethodOverrides& p) { p.iterations = 0; }},
                      Variant{"one_iteration", MatchMethod::kMembrane,
                              [](MethodOverrides& p) { p.iterations = 1; }},
                      Variant{"fifty_iterations", MatchMethod::kMembrane,
                              [](MethodOverrides& p) { p.iterations = 50; }},
                      Variant{"steps", MatchMethod::kDiffusion,
                              [](MethodOverrides& p) {
                                p.iterations = 25;
                                p.lambda = 0.24;
                              }},
                      Variant{"largest_step", MatchMethod::kMembrane,
                              [](MethodOverrides& p) {
                                p.lambda = 0.2;
                                p.beta = 1;
                              }},
                      Variant{"no_pull", MatchMethod::kMembrane,
                              [](MethodOverrides& p) { p.beta = 0; }},
                      Variant{"stopping_once", MatchMethod::kLocalStopping,
                              [](MethodOverrides& p) { p.iterations = 1; }},
                      Variant{"stopping_never_begun", MatchMethod::kLocalStopping,
                              [](MethodOverrides& p) { p.iterations = 0; }},
                      Variant{"stopping_thirty", MatchMethod::kLocalStopping,
                              [](MethodOverrides& p) { p.iterations = 30; }},
                      Variant{"sure_entropy", MatchMethod::kLocalStopping,
                              [](MethodOverrides& p) { p.certainty = Certainty::kEntropy; }},
                      Variant{"entropy", MatchMethod::kLocalStopping,
                              [](MethodOverrides& p) {
                                p.certainty = Certainty::kEntropy;
                                p.sigma_measurement = 20;
                              }}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Bayes, MethodVariants,
    ::testing::Values(
        Variant{"prior_only_at_start", kBayes, [](MethodOverrides& p) { p.iterations = 0; }},
        Variant{"once", kBayes, [](MethodOverrides& p) { p.iterations = 1; }},
        Variant{"fifty", kBayes, [](MethodOverrides& p) { p.iterations = 50; }},
        Variant{"planar", kBayes,
                [](MethodOverrides& p) {
                  p.sigma_prior = 0.1;
                  p.sigma_measurement = 2;
                }},
        Variant{"two_taps", kBayes, [](MethodOverrides& p) { p.sigma_prior = 0.7; }},
        Variant{"wide_prior", kBayes, [](MethodOverrides& p) { p.sigma_prior = 3; }},
        Variant{"endless_prior", kBayes, [](MethodOverrides& p) { p.sigma_prior = 200; }},
        Variant{"mu_small", kBayes, [](MethodOverrides& p) { p.mu = 0.1; }},
        Variant{"mu_one", kBayes,
                [](MethodOverrides& p) {
                  p.mu = 1;
                  p.sigma_measurement = 20;
                }},
        Variant{"mu_other_wide", kBayes,
                [](MethodOverrides& p) {
                  p.iterations = 20;
                  p.mu = 0.45;
                  p.sigma_prior = 1.5;
                }},
        Variant{"sure_prior", kBayes, [](MethodOverrides& p) { p.epsilon_prior = 1e-6; }},
        Variant{"surest_prior", kBayes, [](MethodOverrides& p) { p.epsilon_prior = 1e-9; }},
        Variant{"impulse", kBayes, [](MethodOverrides& p) { p.prior = Prior::kImpulse; }},
        Variant{"impulse_maximum", kBayes,
                [](MethodOverrides& p) {
                  p.prior = Prior::kImpulse;
                  p.prior_smoothing = PriorSmoothing::kMaximum;
                  p.iterations = 5;
                }},
        Variant{"quadratic", kBayes, [](MethodOverrides& p) { p.prior = Prior::kQuadratic; }},
        Variant{"quadratic_maximum", kBayes,
                [](MethodOverrides& p) {
                  p.prior = Prior::kQuadratic;
                  p.prior_smoothing = PriorSmoothing::kMaximum;
                }},
        Variant{"quadratic_wide", kBayes,
                [](MethodOverrides& p) {
                  p.prior = Prior::kQuadratic;
                  p.sigma_prior = 6;
                  p.mu = 0.3;
                }},
        Variant{"quadratic_narrow", kBayes,
                [](MethodOverrides& p) {
                  p.prior = Prior::kQuadratic;
                  p.sigma_prior = 0.2;
                }},
        Variant{"unsure", kBayes,
                [](MethodOverrides& p) {
                  p.epsilon_prior = 0.4;
                  p.epsilon_measurement = 0.6;
                }},
        Variant{"sure_measurement", kBayes,
                [](MethodOverrides& p) { p.epsilon_measurement = 1e-5; }}),
    name_of);

class AwkwardShapes : public ::testing::TestWithParam<MethodCase> {};

TEST_P(AwkwardShapes, EqualTheOracle) {
  if (test::is_stepped(GetParam())) {
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
    test::Tolerance tolerance = tolerance_of(options.resolved());
    if (options.resolved().aggregation == Aggregation::kLocalStopping) {
      tolerance.strays = 5;  // an eleventh of such small images lies beside a stray pixel
    }
    expect_equals_oracle(pair, options, execution, tolerance, name);
  }
}

/// No texture: every candidate is as good, the smallest disparity with a partner wins. Under
/// Bayesian diffusion not quite: candidates beside others that are likely are more likely.
TEST_P(AwkwardShapes, ConstantImagesTakeTheSmallestDisparity) {
  Execution execution({.threads = 2});
  Image<std::uint8_t> left(23, 12);
  Image<std::uint8_t> right(23, 12);
  left.fill(77);
  right.fill(77);
  const PhotographPair pair{{std::move(left)}, {std::move(right)}};
  MatchOptions options = GetParam().options;
  options.disparities = {-4, 9};
  expect_equals_oracle(pair, options, execution, tolerance_of(options.resolved()), "constant");
  if (options.resolved().aggregation == Aggregation::kBayes) {
    return;
  }
  DisparityMaps maps;
  StereoMatcher(options, execution).match(pair.left, pair.right, {}, maps);
  const int margin =
      options.resolved().border == Border::kValid ? options.resolved().window_px / 2 : 0;
  for (int y = margin; y < 12 - margin; ++y) {
    for (int x = margin; x < 23 - margin; ++x) {
      EXPECT_EQ(maps.left.disparity_px.at(x, y), std::max(-4, x - 22 + margin)) << x << ", " << y;
      EXPECT_EQ(maps.right.disparity_px.at(x, y), std::max(-4, -x + margin)) << x << ", " << y;
    }
  }
}

TEST_P(AwkwardShapes, RangesWithoutAnyCandidateAreRefused) {
  Execution execution({.threads = 1});
  const auto pair = textured_pair(20, 10, {0, 5}, PixelKind::kGrey8, 6);
  MatchOptions options = GetParam().options;
  for (const DisparityRange range : {DisparityRange{20, 30}, DisparityRange{-60, -20}}) {
    options.disparities = range;
    DisparityMaps maps;
    EXPECT_THROW(StereoMatcher(options, execution).match(pair.left, pair.right, {}, maps), Error);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, AwkwardShapes, ::testing::ValuesIn(method_cases({})),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace method_variants_test
}  // namespace vantage
