#include "engine/refinement/kept_refinement.h"

#include "tests/engine/engine_test.h"

namespace vantage::kept_refinement_test {

constexpr int kWidth = 4 * TileMask::kSidePx;
constexpr int kHeight = TileMask::kSidePx + 3;

MatchedMap map_of(float disparity_px) {
  MatchedMap map{.disparity_px = DisparityMap(kWidth, kHeight), .unmatched = Mask(kWidth, kHeight)};
  map.disparity_px.fill(disparity_px);
  map.unmatched.fill(0);
  return map;
}

class KeptRefinementTest : public ::testing::Test {
 protected:
  /// The refined map where tile (`searched`, 0) has new winners, all of them `disparity_px`.
  DisparityMap refine(int searched, MatchedMap& map) {
    TileMask tiles(kWidth, kHeight, false);
    tiles.set(searched, 0);
    kept_.start(tiles);
    kept_.find_changed(map.unmatched);
    kept_.restore(map.disparity_px);
    kept_.remember(map);
    return map.disparity_px.copy();
  }
  KeptRefinementTest() {
    MatchedMap first = map_of(1);
    first.unmatched.at(40, 5) = 255;
    kept_.start(TileMask(kWidth, kHeight, true));
    kept_.find_changed(first.unmatched);
    kept_.restore(first.disparity_px);
    kept_.remember(first);
  }
  KeptRefinement kept_;
};

TEST_F(KeptRefinementTest, TilesKeepTheirValuesUnlessSearched) {
  MatchedMap map = map_of(2);
  map.unmatched.at(40, 5) = 255;
  const DisparityMap refined = refine(1, map);
  EXPECT_EQ(refined.at(15, 15), 1);
  EXPECT_EQ(refined.at(16, 15), 2);
  EXPECT_EQ(refined.at(31, 0), 2);
  EXPECT_EQ(refined.at(32, 0), 1);
  EXPECT_EQ(refined.at(16, 16), 1);  // the tile below
  MatchedMap next = map_of(3);
  next.unmatched.at(40, 5) = 255;
  EXPECT_EQ(refine(0, next).at(16, 0), 2);
}

TEST_F(KeptRefinementTest, TilesWhoseUnmatchedPixelsChangedAreRefined) {
  MatchedMap map = map_of(2);  // with (40, 5) matched
  const DisparityMap refined = refine(0, map);
  EXPECT_EQ(refined.at(32, 0), 2);
  EXPECT_EQ(refined.at(31, 0), 1);
  EXPECT_EQ(refined.at(48, 0), 1);
}

TEST_F(KeptRefinementTest, UnmatchedPixelsThatContinueFromAChangedTileAreFilledWithIt) {
  const auto with_gap = [](float disparity_px) {
    MatchedMap map = map_of(disparity_px);
    for (int x = 20; x < 40; ++x) {
      map.unmatched.at(x, 5) = 255;
    }
    return map;
  };
  MatchedMap map = with_gap(2);
  refine(1, map);
  MatchedMap next = with_gap(3);
  const DisparityMap refined = refine(1, next);
  EXPECT_EQ(refined.at(32, 0), 3);  // the gap reaches into it
  EXPECT_EQ(refined.at(48, 0), 1);
  EXPECT_EQ(refined.at(15, 0), 1);
}

TEST_F(KeptRefinementTest, NothingIsKeptAfterARestart) {
  kept_.restart();
  MatchedMap map = map_of(2);
  kept_.start(TileMask(kWidth, kHeight, true));
  kept_.find_changed(map.unmatched);
  kept_.restore(map.disparity_px);
  EXPECT_EQ(map.disparity_px.at(0, 0), 2);
  EXPECT_TRUE(kept_.refined_px().empty());
}

}  // namespace vantage::kept_refinement_test
