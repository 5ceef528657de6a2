#include "engine/matching/range_check.h"

#include "engine/generation/book_pairs.h"
#include "engine/generation/layered_scene.h"
#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"

namespace vantage::range_check_test {

struct Checked {
  bool may_be_cut = false;
  CutRange cut;
};

Checked checked(const Photograph& left, const Photograph& right, DisparityRange range,
                Execution& execution) {
  MatchOptions options;
  options.disparities = range;
  DisparityMaps maps;
  StereoMatcher(options, execution).match(left, right, {}, maps);
  const MatchesAtEnds matches = matches_at_ends(maps, options);
  return {may_be_cut(matches, options, false),
          look_beyond(matches, left, right, options, execution)};
}

TEST(RangeCheck, TellsWhatACutRangeLeavesOut) {
  LayeredSceneOptions options;
  options.width_px = 320;
  options.height_px = 200;
  options.far_disparity_px = 8;
  options.near_disparity_px = 34;
  options.samples_per_side = 1;
  const LayeredScene scene(options, execution());
  const Photograph left = scene.render({0, 0}, 0).image;
  const Photograph right = scene.render({1, 0}, 0).image;

  EXPECT_FALSE(checked(left, right, {2, 40}, execution()).may_be_cut);

  const Checked above = checked(left, right, {2, 16}, execution());
  EXPECT_TRUE(above.may_be_cut);
  EXPECT_TRUE(above.cut.above);
  EXPECT_FALSE(above.cut.below);
  EXPECT_THAT(to_text(above.cut, {2, 16}), HasSubstr("disparities above 16 seem to be left out"));

  const Checked below = checked(left, right, {16, 40}, execution());
  EXPECT_TRUE(below.cut.below);
  EXPECT_FALSE(below.cut.above);
  EXPECT_THAT(to_text(below.cut, {16, 40}), HasSubstr("disparities below 16 seem to be left out"));
}

TEST(RangeCheck, ASceneMayEndWhereTheRangeDoes) {
  BookPairOptions options = book_pair_options("real-square");
  options.width_px = 240;
  options.height_px = 160;
  options.background_disparity_px = 5;
  options.front_disparity_px = 11;
  const BookPair pair = make_book_pair(options);
  const Checked exact = checked(pair.left, pair.right, {5, 11}, execution());
  EXPECT_TRUE(exact.may_be_cut);
  EXPECT_FALSE(exact.cut.any()) << to_text(exact.cut, {5, 11});
}

TEST(RangeCheck, ASurfaceFarBeyondLeavesPixelsWithoutMatch) {
  BookPairOptions options = book_pair_options("real-square");
  options.width_px = 240;
  options.height_px = 160;
  options.background_disparity_px = 40;
  options.front_disparity_px = 60;
  const BookPair pair = make_book_pair(options);
  const Checked checked_range = checked(pair.left, pair.right, {50, 70}, execution());
  EXPECT_TRUE(checked_range.may_be_cut);
  EXPECT_TRUE(checked_range.cut.below);
  EXPECT_FALSE(checked_range.cut.above);
}

TEST(RangeCheck, PilesDecideWhereNothingElseCan) {
  BookPairOptions options;
  options.width_px = 120;
  options.height_px = 60;
  const BookPair pair = make_book_pair(options);
  MatchOptions match;
  match.disparities = {-20, 60};  // beyond what is searched in such images
  const CutRange cut =
      look_beyond({.at_min = 0, .at_max = 0.05}, pair.left, pair.right, match, execution());
  EXPECT_TRUE(cut.above);
  EXPECT_FALSE(cut.below);
}

TEST(RangeCheck, ARangeThatWasFoundMayEndAtInfinity) {
  MatchOptions options;
  options.disparities = {0, 20};
  EXPECT_FALSE(may_be_cut({.at_min = 0.5, .at_max = 0}, options, true));
  EXPECT_TRUE(may_be_cut({.at_min = 0.5, .at_max = 0}, options, false));
  EXPECT_TRUE(may_be_cut({.at_min = 0, .at_max = 0.5}, options, true));
}

}  // namespace vantage::range_check_test
