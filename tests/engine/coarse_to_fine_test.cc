// Matching with several levels: against the plain transcription, and what it must not depend on.
#include "engine/matching/search/coarse_to_fine/coarse_to_fine.h"
#include "engine/matching/levels/level_extents.h"

#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"
#include "tests/test_sample.h"

namespace vantage::coarse_to_fine_test {

using scheduler::Extent;

TEST(LevelExtents, HalveAndRoundUp) {
  const std::vector<Extent> expected = {{37, 29}, {19, 15}, {10, 8}, {5, 4}};
  EXPECT_EQ(level_extents({37, 29}, 4), expected);
  EXPECT_EQ(level_extents({37, 29}, 1), (std::vector<Extent>{{37, 29}}));
}

TEST(LevelExtents, LeaveOutSinglePixels) {
  EXPECT_EQ(level_extents({1, 1}, 10), (std::vector<Extent>{{1, 1}}));
  EXPECT_EQ(level_extents({2, 2}, 10), (std::vector<Extent>{{2, 2}}));
  EXPECT_EQ(level_extents({1, 7}, 10), (std::vector<Extent>{{1, 7}, {1, 4}, {1, 2}}));
  EXPECT_EQ(level_extents({5, 3}, 10), (std::vector<Extent>{{5, 3}, {3, 2}, {2, 1}}));
}

MatchOptions options_of(Aggregation aggregation, MatchCost cost, int levels, DisparityRange range) {
  MatchOptions options;
  options.disparities = range;
  options.parameters.aggregation = aggregation;
  options.parameters.cost = cost;
  options.parameters.levels = levels;
  options.parameters.subpixel = Subpixel::kNone;
  if (aggregation == Aggregation::kDiffusion || aggregation == Aggregation::kMembrane ||
      aggregation == Aggregation::kLocalStopping || aggregation == Aggregation::kBayes) {
    options.parameters.iterations = 3;
  }
  if (aggregation == Aggregation::kBox) {
    options.parameters.window_px = 5;
  }
  if (cost == MatchCost::kGradient && aggregation == Aggregation::kLocalStopping) {
    options.parameters.certainty = Certainty::kEntropy;  // there is no margin of evidence
  }
  return options;
}

/// Stored cells that lie half way between two steps may be rounded either way, which then changes
/// what starts from them.
Tolerance tolerance_with_levels(const MethodParameters& parameters) {
  Tolerance tolerance = tolerance_of(parameters);
  tolerance.tie = std::max(tolerance.tie, 1e-3);
  tolerance.share = 0.995;
  tolerance.confidence = std::max(tolerance.confidence, 5e-3);
  tolerance.confidence_share = std::min(tolerance.confidence_share, 0.99);
  tolerance.strays = 2;
  return tolerance;
}

using Combination = std::tuple<Aggregation, MatchCost>;

class CoarseToFine : public ::testing::TestWithParam<Combination> {};

TEST_P(CoarseToFine, EqualsTheOracle) {
  const auto [aggregation, cost] = GetParam();
  struct Shape {
    int width;
    int height;
    DisparityRange range;
  };
  for (const Shape& shape :
       {Shape{1, 1, {0, 0}}, Shape{1, 7, {-2, 2}}, Shape{13, 11, {0, 4}}, Shape{13, 11, {0, 39}},
        Shape{37, 29, {-4, 12}}, Shape{37, 29, {0, 39}}}) {
    const auto pair = textured_pair(shape.width, shape.height, shape.range, PixelKind::kGrey8, 3);
    for (const int levels : {2, 4}) {
      const MatchOptions options = options_of(aggregation, cost, levels, shape.range);
      expect_equals_oracle(pair, options, execution(), tolerance_with_levels(options.resolved()),
                           std::to_string(shape.width) + "x" + std::to_string(shape.height) + ", " +
                               std::to_string(levels) + " levels, " +
                               std::to_string(shape.range.count()) + " candidates");
    }
  }
}

/// Evidence, prior, iterations and weights of neighbours that differ from level to level.
TEST(CoarseToFineOfEdges, EqualsTheOracle) {
  struct Shape {
    int width;
    int height;
    DisparityRange range;
    PixelKind pixels;
  };
  constexpr Shape kShapes[] = {{1, 1, {0, 0}, PixelKind::kGrey8},
                               {1, 7, {-2, 2}, PixelKind::kGrey8},
                               {13, 11, {0, 39}, PixelKind::kGrey8},
                               {37, 29, {-4, 12}, PixelKind::kColour8},
                               {61, 43, {0, 16}, PixelKind::kGrey8}};
  constexpr int kLevels[] = {1, 2, 5};
  struct Prior {
    PriorSmoothing smoothing;
    double epsilon;
    int final_iterations;
    vantage::Prior shape = vantage::Prior::kContaminatedGaussian;
    double slant_penalty = std::numeric_limits<double>::infinity();
  };
  constexpr Prior kPriors[] = {
      {PriorSmoothing::kSum, 5e-6, 2},
      {PriorSmoothing::kSum, 5e-6, 2, vantage::Prior::kContaminatedGaussian, 0.5},
      {PriorSmoothing::kMaximum, 5e-6, 2, vantage::Prior::kContaminatedGaussian, 0.25},
      {PriorSmoothing::kMaximum, 5e-6, 0, vantage::Prior::kContaminatedGaussian, 0},
      {PriorSmoothing::kMaximum, 0.4, 1},
      {PriorSmoothing::kMaximum, 0.7, 1},
      {PriorSmoothing::kSum, 5e-6, 2, vantage::Prior::kImpulse},
      {PriorSmoothing::kMaximum, 5e-6, 2, vantage::Prior::kImpulse},
      {PriorSmoothing::kSum, 0.01, 2, vantage::Prior::kQuadratic},
      {PriorSmoothing::kMaximum, 0.01, 0, vantage::Prior::kQuadratic}};
  for (const SampleRow& row : sampled_rows({5, 3, std::size(kPriors)})) {
    const Shape& shape = kShapes[row[0]];
    const int levels = kLevels[row[1]];
    const Prior& prior = kPriors[row[2]];
    const auto pair = textured_pair(shape.width, shape.height, shape.range, shape.pixels, 3);
    const MatchCost cost = levels == 5 ? MatchCost::kCensus : MatchCost::kRayCensus;
    MatchOptions options = options_of(Aggregation::kBayes, cost, levels, shape.range);
    options.parameters.sigma_measurement = levels == 5 ? 12.4 : 4.8;
    if (cost == MatchCost::kRayCensus) {
      options.parameters.census_thresholds = levels == 2 ? 3 : 1;
    }
    options.parameters.prior = prior.shape;
    if (prior.shape != vantage::Prior::kQuadratic) {
      options.parameters.epsilon_prior = prior.epsilon;
    }
    if (levels > 1) {
      options.parameters.final_iterations = prior.final_iterations;
      if (prior.shape != vantage::Prior::kImpulse) {
        options.parameters.prior_growth = 1.2;
      }
      options.parameters.level_weight = 0.6;
      options.parameters.slant_penalty = prior.slant_penalty;
    }
    options.parameters.edge_weight = 0.2;
    options.parameters.prior_smoothing = prior.smoothing;
    Tolerance tolerance = tolerance_with_levels(options.resolved());
    if (prior.final_iterations == 0) {
      tolerance.tie = 0.1;  // what is chosen from are bytes, of 0.09 nat each
    }
    expect_equals_oracle(pair, options, execution(), tolerance,
                         std::to_string(shape.width) + "x" + std::to_string(shape.height) + ", " +
                             std::to_string(levels) + " levels, " +
                             (prior.smoothing == PriorSmoothing::kSum ? "sum" : "maximum") +
                             " of prior " + std::to_string(static_cast<int>(prior.shape)) +
                             ", epsilon " + std::to_string(prior.epsilon) + ", " +
                             std::to_string(prior.final_iterations) + " final iterations, " +
                             sample_name());
  }
}

/// What bytes and half floats leave out decides few pixels.
TEST_P(CoarseToFine, StoredCellsAreExactEnough) {
  const auto [aggregation, cost] = GetParam();
  const DisparityRange range{0, 15};
  const auto pair = textured_pair(61, 43, range, PixelKind::kGrey8, 4);
  const MethodParameters parameters = options_of(aggregation, cost, 4, range).resolved();
  const auto map_of = [&](StoredCells stored) {
    return plain_match(pair.left, pair.right, Side::kLeft, range, parameters, stored);
  };
  const PlainMap exact = map_of(StoredCells::kExact);
  const PlainMap compact = map_of(StoredCells::kCompact);
  std::size_t equal = 0;
  for (std::size_t k = 0; k < exact.choices.size(); ++k) {
    equal += exact.choices[k].winner == compact.choices[k].winner ? 1 : 0;
  }
  EXPECT_GE(equal, 0.99 * static_cast<double>(exact.choices.size()));
}

INSTANTIATE_TEST_SUITE_P(
    Combinations, CoarseToFine,
    ::testing::Values(Combination{Aggregation::kBayes, MatchCost::kContaminated},
                      Combination{Aggregation::kBayes, MatchCost::kCensus},
                      Combination{Aggregation::kBayes, MatchCost::kRayCensus},
                      Combination{Aggregation::kBayes, MatchCost::kGradient},
                      Combination{Aggregation::kMembrane, MatchCost::kSquared},
                      Combination{Aggregation::kDiffusion, MatchCost::kBirchfieldTomasi},
                      Combination{Aggregation::kLocalStopping, MatchCost::kSquared},
                      Combination{Aggregation::kNone, MatchCost::kAbsolute},
                      Combination{Aggregation::kBox, MatchCost::kSquared},
                      Combination{Aggregation::kBox, MatchCost::kGradient},
                      Combination{Aggregation::kGaussian, MatchCost::kTruncated},
                      Combination{Aggregation::kBoxCascade, MatchCost::kGradient}),
    [](const auto& instance) {
      return case_name(std::get<Aggregation>(instance.param)) + "_" +
             case_name(std::get<MatchCost>(instance.param));
    });

TEST(CoarseToFineMatcher, OneLevelIsFlat) {
  const auto pair = textured_pair(2, 2, {0, 1}, PixelKind::kGrey8, 3);
  MatchOptions options = options_of(Aggregation::kBayes, MatchCost::kContaminated, 1, {0, 1});
  const DisparityMaps flat = maps_of(pair, options);
  options.parameters.levels = 7;  // of which an image of 2×2 pixels has one
  EXPECT_TRUE(identical(maps_of(pair, options), flat));
}

TEST(CoarseToFineMatcher, CountsTheCellsOfAllLevels) {
  const auto pair = textured_pair(37, 29, {0, 9}, PixelKind::kGrey8, 3);
  MatchOptions options = options_of(Aggregation::kBayes, MatchCost::kContaminated, 3, {0, 9});
  options.raw = true;
  MatchReport report;
  maps_of(pair, options, {.threads = 2}, {.confidence = true}, &report);
  EXPECT_EQ(report.cells, 2.0 * 10 * (37 * 29 + 19 * 15 + 10 * 8));
}

TEST(CoarseToFineMatcher, KeepsItsWorkingMemoryFromPairToPair) {
  MatchOptions options = options_of(Aggregation::kBayes, MatchCost::kContaminated, 4, {0, 9});
  const StereoMatcher matcher(options, execution());
  const auto large = textured_pair(37, 29, {0, 9}, PixelKind::kGrey8, 3);
  const auto small = textured_pair(21, 31, {0, 9}, PixelKind::kGrey8, 4);
  DisparityMaps maps;
  for (const auto* pair : {&large, &small, &large}) {
    matcher.match(pair->left, pair->right, {.confidence = true}, maps);
    EXPECT_TRUE(identical(maps, maps_of(*pair, options)));
  }
}

TEST(CoarseToFineMatcher, SeveralImagesGoToo) {
  const auto pair = textured_pair(37, 29, {0, 9}, PixelKind::kGrey8, 3);
  MatchOptions options = options_of(Aggregation::kBayes, MatchCost::kContaminated, 3, {0, 9});
  options.raw = true;
  DisparityMaps of_one;
  const OtherView other{&pair.right, 1};
  StereoMatcher(options, execution()).match_several(pair.left, {&other, 1}, {}, of_one);
  EXPECT_TRUE(identical(of_one.left.disparity_px, maps_of(pair, options).left.disparity_px));
}

TEST(CoarseToFineMatcher, PruningOfVerticalSearchIsRefused) {
  MatchOptions options = options_of(Aggregation::kBayes, MatchCost::kContaminated, 3, {0, 9});
  options.disparities_y = DisparityRange{-1, 1};
  options.parameters.prior_smoothing = PriorSmoothing::kMaximum;
  options.parameters.candidate_blocks = 2;
  EXPECT_EQ(error_of([&] { const StereoMatcher matcher(options, execution()); }),
            "candidate-blocks is 2, expected 0 with disparities-y: blocks are of candidates along "
            "rows");
}

}  // namespace vantage::coarse_to_fine_test
