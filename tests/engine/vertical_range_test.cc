#include "engine/matching/vertical_range.h"

#include "engine/generation/layered_scene.h"
#include "engine/image/transposed.h"
#include "engine/io/images/photograph_io.h"
#include "engine/matching/range_estimation.h"
#include "tests/engine/engine_test.h"
#include "tests/test_paths.h"

namespace vantage::vertical_range_test {

/// The photograph with rows moved up by `rows`, the last one repeated.
template <typename T>
Photograph moved_up(const Image<T>& image, int rows) {
  Image<T> result(image.width(), image.height(), image.channels());
  for (int y = 0; y < image.height(); ++y) {
    const int source = std::clamp(y + rows, 0, image.height() - 1);
    std::copy_n(image.row(source), image.width() * image.channels(), result.row(y));
  }
  return {std::move(result)};
}

Photograph moved_up(const Photograph& photograph, int rows) {
  return std::visit([&](const auto& image) { return moved_up(image, rows); }, photograph.pixels);
}

struct Pair {
  Photograph left;
  Photograph right;
};

Pair made_up_scene(Execution& execution) {
  LayeredSceneOptions options;
  options.width_px = 360;
  options.height_px = 270;
  options.far_disparity_px = 6;
  options.near_disparity_px = 30;
  options.samples_per_side = 1;
  const LayeredScene scene(options, execution);
  return {scene.render({0, 0}, 0).image, scene.render({1, 0}, 0).image};
}

void expect_around(DisparityRange range, int value, int max) {
  EXPECT_LT(range.min, value);
  EXPECT_GT(range.max, value);
  EXPECT_LE(range.count(), max) << range.min << ':' << range.max;
}

TEST(VerticalRange, IsAroundTheRowsThatCorrespond) {
  const Pair pair = made_up_scene(execution());
  const DisparityRange of_rectified = estimate_disparity_range(pair.left, pair.right, execution());
  for (const int rows : {0, 3, -11, 40}) {
    SCOPED_TRACE(rows);
    const Photograph right = moved_up(pair.right, rows);
    const auto range = find_vertical_range(pair.left, right, execution());
    ASSERT_TRUE(range);
    expect_around(*range, rows, 5);
    const auto across = find_disparity_range(pair.left, right, execution(), *range);
    ASSERT_TRUE(across);
    EXPECT_NEAR(across->min, of_rectified.min, 4);
    EXPECT_NEAR(across->max, of_rectified.max, 4);
  }
}

TEST(VerticalRange, HoldsTheBaselineOfCamerasOneAboveTheOther) {
  const Pair pair = made_up_scene(execution());
  const Photograph upper = transposed(pair.left);
  const Photograph lower = transposed(pair.right);
  const auto range = find_vertical_range(upper, lower, execution());
  ASSERT_TRUE(range);
  EXPECT_LE(range->min, 8);
  EXPECT_GE(range->max, 26);
  const auto across = find_disparity_range(upper, lower, execution(), *range);
  ASSERT_TRUE(across);
  EXPECT_LE(across->min, 0);
  EXPECT_GE(across->max, 0);
  EXPECT_LE(across->count(), 12) << across->min << ':' << across->max;
}

TEST(VerticalRange, OfPhotographsIsNarrow) {
  const std::filesystem::path data = test_paths::shared_data();
  if (!std::filesystem::exists(data)) {
    GTEST_SKIP() << "no photographs at " << data;
  }
  const Photograph left = read_photograph(data / "cones/im2.png");
  const Photograph right = read_photograph(data / "cones/im6.png");
  for (const int rows : {0, 2, -9}) {
    const auto range = find_vertical_range(left, moved_up(right, rows), execution());
    ASSERT_TRUE(range);
    expect_around(*range, rows, 5);
  }
}

TEST(VerticalRange, NeedsPointsInCommon) {
  Image<std::uint8_t> grey(200, 100);
  grey.fill(77);
  const Photograph constant{std::move(grey)};
  EXPECT_FALSE(find_vertical_range(constant, constant, execution()));
  EXPECT_FALSE(find_vertical_range(noise<std::uint8_t>(200, 100, 1, 1),
                                   noise<std::uint8_t>(200, 100, 1, 2), execution()));
  EXPECT_THAT(error_of([&] {
                find_vertical_range(noise<std::uint8_t>(20, 10, 1), noise<std::uint8_t>(20, 11, 1),
                                    execution());
              }),
              HasSubstr("expected equal sizes"));
}

}  // namespace vantage::vertical_range_test
