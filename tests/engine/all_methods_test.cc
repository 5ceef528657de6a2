// Every cost under every aggregation against the plain transcription of the equations.
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "tests/engine/oracle_comparison.h"

namespace vantage {
namespace all_methods_test {

using test::expect_equals_oracle;
using test::name_of;
using test::PixelKind;
using test::textured_pair;
using test::tolerance_of;

using Combination = std::tuple<MatchCost, Aggregation>;

MatchOptions options_of(const Combination& combination, DisparityRange range, Subpixel subpixel) {
  MatchOptions options;
  options.disparities = range;
  options.parameters.cost = std::get<MatchCost>(combination);
  options.parameters.aggregation = std::get<Aggregation>(combination);
  options.parameters.subpixel = subpixel;
  if (options.parameters.aggregation == Aggregation::kBox) {
    options.parameters.window_px = 5;
  }
  if (options.parameters.cost == MatchCost::kGradient) {
    options.parameters.certainty = Certainty::kEntropy;  // there is no margin of evidence
  }
  return options;
}

class AllMethods : public ::testing::TestWithParam<Combination> {};

TEST_P(AllMethods, EqualTheOracle) {
  Execution execution({.threads = 2});
  for (const DisparityRange range : {DisparityRange{0, 12}, DisparityRange{-7, 29}}) {
    const auto pair = textured_pair(61, 43, range, PixelKind::kGrey8, 1);
    const MatchOptions options = options_of(GetParam(), range, Subpixel::kNone);
    expect_equals_oracle(pair, options, execution, tolerance_of(options.resolved()),
                         "range " + std::to_string(range.min));
  }
}

TEST_P(AllMethods, EqualTheOracleBetweenPixelsAndInColour) {
  Execution execution({.threads = 2});
  const DisparityRange range{-2, 10};
  for (const PixelKind kind : {PixelKind::kColour8, PixelKind::kGreyFloat}) {
    const auto pair = textured_pair(47, 31, range, kind, 2);
    for (const ColourUse colour : {ColourUse::kLuma, ColourUse::kChannels}) {
      MatchOptions options = options_of(GetParam(), range, Subpixel::kParabola);
      options.parameters.colour = colour;
      expect_equals_oracle(pair, options, execution, tolerance_of(options.resolved()),
                           colour == ColourUse::kLuma ? "luma" : "channels");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Combinations, AllMethods,
    ::testing::Combine(::testing::Values(MatchCost::kSquared, MatchCost::kAbsolute,
                                         MatchCost::kTruncated, MatchCost::kBirchfieldTomasi,
                                         MatchCost::kGradient, MatchCost::kContaminated,
                                         MatchCost::kCensus, MatchCost::kRayCensus),
                       ::testing::Values(Aggregation::kNone, Aggregation::kBox,
                                         Aggregation::kGaussian, Aggregation::kBoxCascade,
                                         Aggregation::kDiffusion, Aggregation::kMembrane,
                                         Aggregation::kLocalStopping, Aggregation::kBayes)),
    [](const auto& instance) {
      return name_of(std::get<MatchCost>(instance.param)) + "_" +
             name_of(std::get<Aggregation>(instance.param));
    });

}  // namespace all_methods_test
}  // namespace vantage
