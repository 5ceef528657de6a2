// The map of a camera in the middle of both: against a scene rendered from there.
#include "engine/matching/selection/cyclopean_map.h"

#include "engine/generation/layered_scene.h"
#include "tests/engine/engine_test.h"

namespace vantage::cyclopean_map_test {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint8_t kUnmatched = 255;

MatchedMap row_of(const std::vector<float>& disparities_px) {
  MatchedMap map;
  const int width = static_cast<int>(disparities_px.size());
  map.disparity_px.resize(width, 1);
  map.unmatched.resize(width, 1);
  for (int x = 0; x < width; ++x) {
    map.disparity_px.at(x, 0) = disparities_px[static_cast<std::size_t>(x)];
    map.unmatched.at(x, 0) =
        std::isnan(disparities_px[static_cast<std::size_t>(x)]) ? kUnmatched : 0;
  }
  return map;
}

CyclopeanMap cyclopean_of(const MatchedMap& left) {
  CyclopeanMap map;
  make_cyclopean_map(left, execution(), map);
  return map;
}

TEST(CyclopeanMap, SurfaceInFrontHidesWhatEachCameraSeesBesideIt) {
  // A background of disparity 2 and columns 8 to 13 at 6 in the left image.
  const CyclopeanMap map = cyclopean_of(
      row_of({kNaN, kNaN, 2, 2, kNaN, kNaN, kNaN, kNaN, 6, 6, 6, 6, 6, 6, 2, 2, 2, 2, 2, 2, 2, 2}));
  const std::vector<float> expected = {kNaN, 2,    2, kNaN, kNaN, 6, 6, 6, 6, 6, 6,
                                       kNaN, kNaN, 2, 2,    2,    2, 2, 2, 2, 2, kNaN};
  const std::vector<SeenBy> seen = {
      SeenBy::kLeft,  SeenBy::kBoth, SeenBy::kBoth, SeenBy::kLeft, SeenBy::kLeft, SeenBy::kBoth,
      SeenBy::kBoth,  SeenBy::kBoth, SeenBy::kBoth, SeenBy::kBoth, SeenBy::kBoth, SeenBy::kRight,
      SeenBy::kRight, SeenBy::kBoth, SeenBy::kBoth, SeenBy::kBoth, SeenBy::kBoth, SeenBy::kBoth,
      SeenBy::kBoth,  SeenBy::kBoth, SeenBy::kBoth, SeenBy::kRight};
  for (int x = 0; x < map.disparity_px.width(); ++x) {
    const float value = expected[static_cast<std::size_t>(x)];
    EXPECT_TRUE(map.disparity_px.at(x, 0) == value ||
                (std::isnan(value) && std::isnan(map.disparity_px.at(x, 0))))
        << x << ": " << map.disparity_px.at(x, 0);
    EXPECT_EQ(map.seen_by.at(x, 0), static_cast<std::uint8_t>(seen[static_cast<std::size_t>(x)]))
        << x;
  }
}

TEST(CyclopeanMap, SlantedSurfacesHaveNoGaps) {
  // Disparities that grow by a third and fall by one per column.
  for (const float slope : {1 / 3.0F, -1.0F}) {
    std::vector<float> disparities_px(40);
    for (std::size_t x = 0; x < disparities_px.size(); ++x) {
      disparities_px[x] = 3 + slope * (static_cast<float>(x) - 20);
    }
    const CyclopeanMap map = cyclopean_of(row_of(disparities_px));
    for (int x = 12; x < 28; ++x) {
      // left = x + d / 2 and d = 3 + slope (left - 20)
      const float expected = (3 + slope * (static_cast<float>(x) - 20)) / (1 - slope / 2);
      EXPECT_NEAR(map.disparity_px.at(x, 0), expected, 1e-4);
      EXPECT_EQ(map.seen_by.at(x, 0), static_cast<std::uint8_t>(SeenBy::kBoth));
    }
  }
}

TEST(CyclopeanMap, NothingMatchedIsSeenByNone) {
  const CyclopeanMap map = cyclopean_of(row_of({kNaN, kNaN, kNaN}));
  EXPECT_TRUE(std::isnan(map.disparity_px.at(1, 0)));
  EXPECT_EQ(map.seen_by.at(1, 0), static_cast<std::uint8_t>(SeenBy::kNone));
}

TEST(CyclopeanMap, AgreesWithASceneRenderedFromTheMiddle) {
  LayeredSceneOptions options;
  options.width_px = 160;
  options.height_px = 120;
  const LayeredScene scene(options, execution());
  const SceneView left{0, 0};
  const SceneView middle{0.5, 0};
  const SceneView right{1, 0};
  MatchedMap matched{.disparity_px = scene.render(left, 0).disparity};
  matched.unmatched = scene.occlusion(left, right, 0);
  CyclopeanMap map;
  make_cyclopean_map(matched, execution(), map);
  const DisparityMap truth = scene.render(middle, 0).disparity;
  const Mask hidden_left = scene.occlusion(middle, left, 0);
  const Mask hidden_right = scene.occlusion(middle, right, 0);
  int both = 0;
  int both_right = 0;
  int one = 0;
  int one_right = 0;
  for (const auto [x, y] : positions_of(truth)) {
    const bool of_left = hidden_left.at(x, y) == 0;
    const bool of_right = hidden_right.at(x, y) == 0;
    const auto seen = static_cast<SeenBy>(map.seen_by.at(x, y));
    if (of_left && of_right) {
      ++both;
      both_right += std::abs(map.disparity_px.at(x, y) - truth.at(x, y)) < 0.5F ? 1 : 0;
    } else if (of_left != of_right) {
      ++one;
      one_right += seen == (of_left ? SeenBy::kLeft : SeenBy::kRight) ? 1 : 0;
    }
  }
  EXPECT_GT(both, 10000);
  EXPECT_GT(one, 300);
  // Thin surfaces and outlines between pixels are not exact.
  EXPECT_GT(both_right, 0.97 * both) << both_right << " of " << both;
  EXPECT_GT(one_right, 0.8 * one) << one_right << " of " << one;
}

}  // namespace vantage::cyclopean_map_test
