// The finest levels of a search of whole images, in windows (EQUATIONS §3.13).
#include "engine/matching/windows/window_level.h"

#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::fine_windows_test {

MatchOptions options_of(DisparityRange range, int window_levels) {
  MatchOptions options;
  options.method = MatchMethod::kBayes;
  options.disparities = range;
  options.raw = true;
  options.parameters.cost = MatchCost::kRayCensus;
  options.parameters.sigma_measurement = 4;
  options.parameters.levels = 4;
  options.parameters.iterations = 2;
  options.parameters.final_iterations = 2;
  options.parameters.prior_smoothing = PriorSmoothing::kMaximum;
  options.parameters.edge_weight = 0.2;
  options.parameters.prior_growth = 1.3;
  options.parameters.window_levels = window_levels;
  return options;
}

/// Share of pixels whose disparities differ by more than half a pixel, or are known in one map.
double share_of_differences(const DisparityMap& a, const DisparityMap& b) {
  int different = 0;
  for (const auto [x, y] : positions_of(a)) {
    const bool are_near = std::isnan(a.at(x, y)) ? std::isnan(b.at(x, y))
                                                 : std::fabs(a.at(x, y) - b.at(x, y)) <= 0.5F;
    different += are_near ? 0 : 1;
  }
  return static_cast<double>(different) / (a.width() * a.height());
}

// A window then holds all candidates: formats and the weight of level 1 are what differs.
TEST(FineWindows, NearlyEqualTheSearchOfAllOfEightCandidates) {
  const auto pair = textured_pair(131, 77, {-2, 5}, PixelKind::kGrey8, 3);
  for (const int thresholds : {1, 3}) {
    MatchOptions all = options_of({-2, 5}, 0);
    all.parameters.census_thresholds = thresholds;
    all.parameters.candidate_blocks = 0;
    const DisparityMaps expected = maps_of(pair, all);
    MatchOptions options = all;
    options.parameters.window_levels = 1;
    const DisparityMaps maps = maps_of(pair, options);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      EXPECT_LT(share_of_differences(maps.of(side).disparity_px, expected.of(side).disparity_px),
                0.005)
          << thresholds << " thresholds";
    }
  }
}

TEST(FineWindows, AreIdenticalForAnyExecutionAndRequest) {
  const auto pair = textured_pair(117, 71, {-3, 40}, PixelKind::kGrey8, 4);
  DisparityMap prior_px(117, 71);
  prior_px.fill(7);
  for (const int blocks : {1, 2}) {
    MatchOptions options = options_of({-3, 40}, 1);
    options.parameters.census_thresholds = 3;
    options.parameters.candidate_blocks = blocks;
    options.parameters.pruned_levels = 3;
    for (const bool has_prior : {false, true}) {
      MatchRequest request{.confidence = true};
      if (has_prior) {
        request.prior = {prior_px.view(), prior_px.view(), 0.5};
      }
      const DisparityMaps expected = maps_of(
          pair, options, {.threads = 1, .executor = scheduler::ExecutorKind::kSerial}, request);
      const DisparityMaps maps = maps_of(
          pair, options, {.threads = 3, .strip_width_px = 33, .band_height_px = 9}, request);
      for (const Side side : {Side::kLeft, Side::kRight}) {
        EXPECT_TRUE(identical(maps.of(side).disparity_px, expected.of(side).disparity_px));
        EXPECT_TRUE(identical(maps.of(side).confidence, expected.of(side).confidence));
      }
      request.right = false;
      EXPECT_TRUE(identical(maps_of(pair, options, {.threads = 2}, request).left.disparity_px,
                            expected.left.disparity_px));
    }
  }
}

TEST(FineWindows, PriorPullsToItsDisparities) {
  // Without texture nothing but the prior says anything.
  const auto grey = [] {
    Image<std::uint8_t> image(64, 48);
    image.fill(90);
    return Photograph{std::move(image)};
  };
  const PhotographPair pair{grey(), grey()};
  DisparityMap prior_px(64, 48);
  prior_px.fill(11);
  const MatchRequest request{.prior = {prior_px.view(), prior_px.view(), 1}};
  const DisparityMaps maps = maps_of(pair, options_of({0, 20}, 1), {.threads = 2}, request);
  EXPECT_NEAR(maps.left.disparity_px.at(40, 20), 11, 0.5);
  EXPECT_NEAR(maps.right.disparity_px.at(20, 20), 11, 0.5);
}

TEST(FineWindows, PresetsDropThemWhereTheyCannotBe) {
  MatchOptions options;
  options.preset = MatchPreset::kBalanced;
  EXPECT_EQ(options.resolved().window_levels, 1);
  for (const auto& change :
       {+[](MatchOptions& o) { o.parameters.colour = ColourUse::kChannels; },
        +[](MatchOptions& o) { o.parameters.cost = MatchCost::kCensus; },
        +[](MatchOptions& o) { o.parameters.prior_smoothing = PriorSmoothing::kSum; },
        +[](MatchOptions& o) { o.parameters.candidate_blocks = 2; },
        +[](MatchOptions& o) { o.parameters.selection = Selection::kScanline; },
        +[](MatchOptions& o) { o.parameters.final_iterations = 0; },
        +[](MatchOptions& o) {
          o.disparities_y = DisparityRange{-1, 1};
        }}) {
    MatchOptions changed = options;
    change(changed);
    EXPECT_EQ(changed.resolved().window_levels, 0);
    EXPECT_NO_THROW(changed.validate());
  }
  options.parameters.window_levels = 1;
  options.parameters.colour = ColourUse::kChannels;
  EXPECT_THROW(options.validate(), UsageError);
  options.parameters.colour.reset();
  EXPECT_NO_THROW(options.validate());
  options.parameters.final_iterations = 0;
  EXPECT_THROW(options.validate(), UsageError);
}

}  // namespace vantage::fine_windows_test
