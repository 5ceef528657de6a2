#include "engine/matching/search_table.h"

#include "engine/matching/options/match_presets.h"
#include "tests/engine/engine_test.h"

namespace vantage::search_table_test {

ResolvedMatchOptions options_of(MatchPreset preset) {
  MatchOptions options;
  options.preset = preset;
  options.disparities = {0, 63};
  return options.in_force();
}

TEST(SearchTable, ImagesAndOptionsChooseTheSearch) {
  const std::vector<double> baselines = {1, 2};
  MatchOptions flat;
  flat.method = MatchMethod::kSsd;
  flat.disparities = {0, 63};
  const auto name_of_search = [](const ResolvedMatchOptions& options, const MatchSize& size) {
    return search_of(options, size).abilities.name;
  };
  const MatchSize pair{.image = {640, 480}};
  EXPECT_EQ(name_of_search(flat.in_force(), pair), "flat");
  EXPECT_EQ(name_of_search(options_of(MatchPreset::kBalanced), pair), "coarse to fine");
  const ResolvedMatchOptions realtime = options_of(MatchPreset::kRealtime);
  EXPECT_EQ(name_of_search(realtime, pair), "windows in reduced images");
  // Which is of two images of some size with common rows.
  EXPECT_EQ(name_of_search(realtime, {.image = {24, 24}}), "coarse to fine");
  EXPECT_EQ(name_of_search(realtime, {.image = {640, 480}, .baselines = baselines}),
            "several images");
  EXPECT_EQ(name_of_search(realtime, {.image = {640, 480}, .along_lines = true}),
            "along epipolar lines");
}

TEST(SearchTable, PlansAreOfTheImagesThatAreSearched) {
  const SearchPlan whole = search_plan(options_of(MatchPreset::kBalanced), {.image = {640, 480}});
  EXPECT_EQ(whole.reductions, 0);
  EXPECT_EQ(whole.levels.extent(0), (scheduler::Extent{640, 480}));
  EXPECT_TRUE(whole.levels.has_windows);
  EXPECT_EQ(whole.deferred_bytes, 0U);
  const SearchPlan reduced = search_plan(options_of(MatchPreset::kRealtime), {.image = {640, 480}});
  EXPECT_EQ(reduced.reductions, 1);
  EXPECT_EQ(reduced.levels.extent(0), (scheduler::Extent{320, 240}));
  EXPECT_EQ(reduced.deferred_bytes, std::size_t{2} * (640 * 480 + 320 * 240));
  EXPECT_LT(reduced.bytes(), whole.bytes());
  // Windows compare two images with common rows.
  EXPECT_FALSE(
      search_plan(options_of(MatchPreset::kBalanced), {.image = {640, 480}, .along_lines = true})
          .levels.has_windows);
}

TEST(SearchTable, RefusesWhatASearchCannotDo) {
  const std::vector<double> baselines = {1, 2};
  ResolvedMatchOptions options = options_of(MatchPreset::kRealtime);
  const MatchSize pair{.image = {640, 480}};
  const VolumeRequest volume;
  EXPECT_NO_THROW(require_abilities(search_of(options, pair).abilities, options));
  const auto refuses = [&](const MatchSize& size, const MatchRequest& request) {
    EXPECT_THROW(require_abilities(search_of(options, size).abilities, options, request),
                 UsageError);
  };
  refuses(pair, {.volumes = {&volume, 1}});
  Image<float> prior_px(640, 480);
  refuses(pair, {.prior = {.left_px = prior_px.view()}});
  options.disparities_y = DisparityRange{0, 1};
  refuses({.image = {640, 480}, .along_lines = true}, {});
  options.disparities_y.reset();
  options.parameters.selection = Selection::kSymmetric;
  refuses({.image = {640, 480}, .along_lines = true}, {});
  refuses({.image = {640, 480}, .baselines = baselines}, {});
}

}  // namespace vantage::search_table_test
