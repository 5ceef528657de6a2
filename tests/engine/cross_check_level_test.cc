// Maps that are checked against a coarse level of the other image's.

#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/search/coarse_to_fine/coarse_to_fine.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/refinement/refinement.h"
#include "scheduler/whole_image_pipeline.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::cross_check_level_test {

constexpr DisparityRange kRange{-3, 37};  // three blocks of candidates

MatchOptions options_of(PriorSmoothing smoothing, int blocks, int levels = 4) {
  MatchOptions options;
  options.method = MatchMethod::kBayes;
  options.disparities = kRange;
  options.parameters.cost = MatchCost::kRayCensus;
  options.parameters.sigma_measurement = 4;
  options.parameters.levels = levels;
  options.parameters.iterations = 2;
  options.parameters.prior_smoothing = smoothing;
  options.parameters.candidate_blocks = blocks;
  options.refinement.cross_check_px = 1;
  options.refinement.fill = Fill::kNone;
  return options;
}

/// The coarse map of one image, and its own unless the coarse one is all.
struct BothMaps {
  DisparityMap whole;
  DisparityMap coarse;
};

BothMaps both_maps_of(const PhotographPair& pair, const MatchOptions& options, Side reference,
                      int level, bool is_only) {
  const MethodParameters parameters = options.resolved();
  const bool is_left = reference == Side::kLeft;
  const Photograph& own = is_left ? pair.left : pair.right;
  const auto geometry =
      candidate_geometry(options.in_force(), reference, own.width(), own.height());
  CostImage left;
  CostImage right;
  left.prepare(pair.left, parameters, geometry, {is_left, false, !is_left}, execution());
  right.prepare(pair.right, parameters, geometry, {!is_left, is_left, false}, execution());
  BothMaps maps{DisparityMap(own.width(), own.height()), DisparityMap(own.width(), own.height())};
  maps.whole.fill(-99);
  EdgeWeightLevels edges;
  CoarseLevels levels;
  const ChainInput input{nullptr,
                         is_left ? &left : &right,
                         {CostPartner{is_left ? &right : &left}},
                         {},
                         0,
                         edges.prepare(own, parameters, execution())};
  Image<std::int32_t> winners;
  CoarseToFine({parameters, geometry, input},
               {.outputs = {.disparity_px = maps.whole.view()},
                .coarse = {.level = level, .winners = &winners, .is_only = is_only}},
               levels, execution(),
               [](const MatchChain& chain) { scheduler::run_whole_image(chain.stages()); })
      .search();
  for (int y = 0; level > 0 && y < own.height(); ++y) {
    for (int x = 0; x < own.width(); ++x) {
      maps.coarse.at(x, y) =
          static_cast<float>(winners.at(x >> level, y >> level) + geometry.disparity_min);
    }
  }
  return maps;
}

using Kind = std::pair<PriorSmoothing, int>;

std::string name_of(const Kind& kind) {
  return std::string(kind.first == PriorSmoothing::kSum ? "Sum" : "Maximum") +
         (kind.second > 0 ? "Pruned" : "");
}

class CrossCheckLevel : public ::testing::TestWithParam<Kind> {
 protected:
  static MatchOptions options(int levels = 4) {
    return options_of(GetParam().first, GetParam().second, levels);
  }
};

TEST_P(CrossCheckLevel, CoarseMapsDoNotDependOnFinerLevels) {
  const auto pair = textured_pair(61, 47, kRange, PixelKind::kColour8, 3);
  for (const Side reference : {Side::kLeft, Side::kRight}) {
    const DisparityMap whole = both_maps_of(pair, options(), reference, 0, false).whole;
    for (const int level : {1, 2, 3}) {
      const BothMaps both = both_maps_of(pair, options(), reference, level, false);
      EXPECT_TRUE(identical(both.whole, whole)) << level;
      const BothMaps alone = both_maps_of(pair, options(), reference, level, true);
      EXPECT_TRUE(identical(alone.coarse, both.coarse)) << level;
      EXPECT_EQ(alone.whole.at(60, 46), -99) << level << ": finer levels were made";
    }
  }
}

TEST_P(CrossCheckLevel, CoarseMapsShowTheScene) {
  Image<std::uint8_t> left(97, 64);
  Image<std::uint8_t> right(97, 64);
  constexpr int kDisparity = 11;
  const auto world = textured_pair(97 + kDisparity, 64, {0, 1}, PixelKind::kGrey8, 5);
  const auto& texture = std::get<Image<std::uint8_t>>(world.left.pixels);
  for (const auto [x, y] : positions_of(97, 64)) {
    left.at(x, y) = texture.at(x, y);
    right.at(x, y) = texture.at(x + kDisparity, y);
  }
  const PhotographPair pair{Photograph{std::move(left)}, Photograph{std::move(right)}};
  for (const int level : {1, 2}) {
    const DisparityMap map = both_maps_of(pair, options(), Side::kRight, level, true).coarse;
    int wrong = 0;
    for (const auto [x, y] : positions_of(97 - kDisparity, 64)) {
      wrong += map.at(x, y) != kDisparity ? 1 : 0;
    }
    EXPECT_LT(wrong, 64 * 86 / 50) << level;
  }
}

/// Against the plain check of raw maps.
TEST_P(CrossCheckLevel, MapsAreCheckedAgainstIt) {
  const auto pair = textured_pair(61, 47, kRange, PixelKind::kGrey8, 3);
  for (const int level : {1, 3}) {
    MatchOptions checked = options();
    checked.refinement.cross_check_level = level;
    MatchOptions raw = options();
    raw.raw = true;
    raw.refinement = {};
    const DisparityMaps winners = maps_of(pair, raw);
    const DisparityMaps maps = maps_of(pair, checked);
    Mask left;
    Mask right;
    cross_check(winners.left.disparity_px.view(),
                both_maps_of(pair, raw, Side::kRight, level, true).coarse.view(), Side::kLeft, 1,
                execution(), left);
    cross_check(winners.right.disparity_px.view(),
                both_maps_of(pair, raw, Side::kLeft, level, true).coarse.view(), Side::kRight, 1,
                execution(), right);
    EXPECT_TRUE(identical(maps.left.unmatched, left)) << level;
    EXPECT_TRUE(identical(maps.right.unmatched, right)) << level;
    MatchOptions whole = options();
    EXPECT_FALSE(identical(maps.left.unmatched, maps_of(pair, whole).left.unmatched)) << level;
  }
}

TEST_P(CrossCheckLevel, MapsDoNotDependOnWhichAreWanted) {
  const auto pair = textured_pair(61, 47, kRange, PixelKind::kColour8, 7);
  MatchOptions options = this->options();
  options.refinement.cross_check_level = 1;
  options.refinement.surface_fit_px = 4;
  options.refinement.edge_snapping_px = 2;
  options.refinement.fill = Fill::kMedian;
  const DisparityMaps both = maps_of(pair, options, {.threads = 1}, {.confidence = true});
  for (const int threads : {1, 3}) {
    const DisparityMaps left = maps_of(pair, options, {.threads = threads},
                                       {.left = true, .right = false, .confidence = true});
    EXPECT_TRUE(identical(left.left.disparity_px, both.left.disparity_px));
    EXPECT_TRUE(identical(left.left.unmatched, both.left.unmatched));
    EXPECT_TRUE(identical(left.left.confidence, both.left.confidence));
    EXPECT_TRUE(left.right.disparity_px.width() == 0);
    const DisparityMaps right = maps_of(pair, options, {.threads = threads},
                                        {.left = false, .right = true, .confidence = true});
    EXPECT_TRUE(identical(right.right.disparity_px, both.right.disparity_px));
    EXPECT_TRUE(identical(right.right.unmatched, both.right.unmatched));
    EXPECT_TRUE(identical(right.right.confidence, both.right.confidence));
    EXPECT_TRUE(right.left.disparity_px.width() == 0);
  }
}

TEST_P(CrossCheckLevel, OfTooFewLevelsItIsTheCoarsest) {
  const auto pair = textured_pair(13, 5, {0, 4}, PixelKind::kGrey8, 3);
  MatchOptions options = this->options(2);
  options.disparities = {0, 4};
  options.refinement.cross_check_level = 1;
  const DisparityMaps maps = maps_of(pair, options);
  options.refinement.cross_check_level = 9;
  EXPECT_TRUE(identical(maps_of(pair, options), maps));
  // A single level: the maps themselves.
  const auto pixel = textured_pair(1, 1, {0, 0}, PixelKind::kGrey8, 3);
  options.disparities = {0, 0};
  EXPECT_EQ(maps_of(pixel, options, {.threads = 2}, {.left = true, .right = false})
                .left.unmatched.at(0, 0),
            0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, CrossCheckLevel,
                         ::testing::Values(Kind{PriorSmoothing::kSum, 0},
                                           Kind{PriorSmoothing::kMaximum, 0},
                                           Kind{PriorSmoothing::kMaximum, 2}),
                         [](const auto& instance) { return name_of(instance.param); });

TEST(CrossCheckLevelOption, IsForLevelsOfBayesianDiffusion) {
  MatchOptions options;
  options.refinement.cross_check_level = 2;
  options.validate();
  options.parameters.levels = 1;
  EXPECT_EQ(error_of([&] { options.validate(); }),
            "cross-check-level is 2, expected 0: only aggregation bayes with levels above 1 and "
            "selection winner has maps of coarse levels");
}

TEST(CrossCheckLevelOption, SavesTheOtherMapsFinestLevel) {
  const auto pair = textured_pair(64, 48, kRange, PixelKind::kGrey8, 3);
  MatchOptions options = options_of(PriorSmoothing::kMaximum, 0);
  const MatchRequest left_only{.left = true, .right = false};
  MatchReport whole;
  maps_of(pair, options, {.threads = 2}, left_only, &whole);
  options.refinement.cross_check_level = 1;
  MatchReport coarse;
  maps_of(pair, options, {.threads = 2}, left_only, &coarse);
  EXPECT_EQ(whole.finest_pixels, 2 * 64 * 48);
  EXPECT_EQ(coarse.finest_pixels, 64 * 48);
  EXPECT_EQ(coarse.finest_cells, 64 * 48 * kRange.count());
  EXPECT_EQ(whole.cells - coarse.cells, 64 * 48 * kRange.count());
  EXPECT_EQ(coarse.plan.passes.size(), whole.plan.passes.size());
  EXPECT_EQ(coarse.plan.step_rows, whole.plan.step_rows);
  // Nor is a map made for a check that is not wanted.
  options.refinement.cross_check_level = 0;
  options.refinement.cross_check = false;
  options.refinement.cross_check_px.reset();
  MatchReport unchecked;
  maps_of(pair, options, {.threads = 2}, left_only, &unchecked);
  EXPECT_EQ(unchecked.cells * 2, whole.cells);
}

}  // namespace vantage::cross_check_level_test
