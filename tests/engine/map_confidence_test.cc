#include "engine/matching/worth/map_confidence.h"

#include "engine/generation/layered_scene.h"
#include "engine/matching/stereo_matcher.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/every_execution.h"

namespace vantage::map_confidence_test {

Photograph mirrored(const Photograph& photograph) {
  const auto& image = std::get<Image<std::uint8_t>>(photograph.pixels);
  Image<std::uint8_t> result(image.width(), image.height(), image.channels());
  for (const auto [x, y] : positions_of(image.width(), image.height())) {
    for (int c = 0; c < image.channels(); ++c) {
      result.at(x, y, c) = image.at(image.width() - 1 - x, y, c);
    }
  }
  return Photograph{std::move(result)};
}

/// A scene with its true map, in whose first rows blocks of 3×3 pixels have any disparity.
struct Scene {
  explicit Scene(int wrong_rows) {
    LayeredSceneOptions options;
    options.width_px = 131;
    options.height_px = 90;
    options.far_disparity_px = 4;
    options.near_disparity_px = 14;
    options.samples_per_side = 1;
    const LayeredScene scene(options, execution());
    auto seen = scene.render({0, 0}, 0);
    left = std::move(seen.image);
    right = scene.render({1, 0}, 0).image;
    map.disparity_px = std::move(seen.disparity);
    map.unmatched.resize(131, 90);
    for (const auto [x, y] : positions_of(131, 90)) {
      map.unmatched.at(x, y) = 0;
      if (y < wrong_rows) {
        std::mt19937 random(static_cast<unsigned>(x / 3 + 100 * (y / 3)));
        map.disparity_px.at(x, y) = static_cast<float>(random() % 19);
      }
    }
  }
  [[nodiscard]] FinishedMap finished() const {
    return {.map = &map, .is_checked = false, .image = &left, .other = &right};
  }
  Photograph left;
  Photograph right;
  MatchedMap map;
};

double mean_of_rows(const Image<float>& values, int first, int end) {
  double sum = 0;
  for (int y = first; y < end; ++y) {
    for (int x = 20; x < values.width(); ++x) {
      sum += values.at(x, y);
    }
  }
  return sum / ((end - first) * (values.width() - 20));
}

TEST(MapConfidence, TellsWrongFromRight) {
  const Scene scene(45);
  Image<float> confidence;
  map_confidence(scene.finished(), execution(), confidence);
  EXPECT_LT(mean_of_rows(confidence, 0, 40), 0.5);
  EXPECT_GT(mean_of_rows(confidence, 50, 90), mean_of_rows(confidence, 0, 40) + 0.25);
  EXPECT_GT(mean_confidence(Scene(0).finished(), execution()), 0.85);
}

TEST(MapConfidence, SidesMirrorEachOther) {
  Scene scene(30);
  scene.map.disparity_px.at(50, 60) = kUnknown;
  Image<float> of_left;
  map_confidence(scene.finished(), execution(), of_left);
  const Photograph left = mirrored(scene.left);
  const Photograph right = mirrored(scene.right);
  MatchedMap map;
  map.disparity_px.resize(131, 90);
  map.unmatched.resize(131, 90);
  for (const auto [x, y] : positions_of(131, 90)) {
    map.unmatched.at(x, y) = 0;
    map.disparity_px.at(x, y) = scene.map.disparity_px.at(130 - x, y);
  }
  Image<float> of_right;
  FinishedMap finished = scene.finished();
  finished.map = &map;
  finished.side = Side::kRight;
  finished.image = &left;
  finished.other = &right;
  map_confidence(finished, execution(), of_right);
  EXPECT_EQ(of_left.at(50, 60), 0);
  for (const auto [x, y] : positions_of(131, 90)) {
    ASSERT_NEAR(of_left.at(x, y), of_right.at(130 - x, y), 0.03) << x << ' ' << y;
  }
}

TEST(MapConfidence, IsTheSameForAnyExecution) {
  const Scene scene(30);
  expect_equal_for_every_execution([&](Execution& other) {
    Image<float> confidence;
    map_confidence(scene.finished(), other, confidence);
    std::vector<double> values = values_of(confidence);
    values.push_back(mean_confidence(scene.finished(), other));
    return values;
  });
}

MatchReport matched(const Photograph& left, const Photograph& right, bool* is_warned) {
  MatchOptions options;
  options.preset = MatchPreset::kRealtime;
  options.disparities = {0, 15};
  DisparityMaps maps;
  MatchReport report;
  StereoMatcher(options, execution()).match(left, right, {.right = false}, maps, &report);
  *is_warned = std::ranges::any_of(report.remarks, [](const Remark& remark) {
    return remark.is_warning() && remark.subject == "map";
  });
  return report;
}

TEST(MapWorth, WarnsOfMapsThatMeasureNothing) {
  const Scene scene(0);
  const Photograph other = mirrored(scene.left);
  Image<std::uint8_t> zero(131, 90);
  zero.fill(0);
  const Photograph black{std::move(zero)};
  bool is_warned = true;
  const MatchReport good = matched(scene.left, scene.right, &is_warned);
  EXPECT_FALSE(is_warned) << good.shares->reliable;
  EXPECT_NEAR(good.shares->matched + good.shares->filled + good.shares->unknown, 1, 1e-12);
  EXPECT_THAT(to_text(*good.shares),
              testing::ContainsRegex("^matched [0-9]+ % of the pixels, filled "));
  matched(scene.left, other, &is_warned);
  EXPECT_TRUE(is_warned);
  EXPECT_LT(matched(black, black, &is_warned).shares->reliable, 0.1);
  EXPECT_TRUE(is_warned);
}

}  // namespace vantage::map_confidence_test
