#include "engine/synthesis/photograph_grid.h"

#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/every_execution.h"

namespace vantage::photograph_grid_test {

constexpr double kHalf = 0.55;  // and what interpolation may be off by

/// Maps whose disparity is the column or the line.
DisparityMap counting_map(int width, int height, bool lines) {
  DisparityMap map(width, height);
  for (const auto [x, y] : positions_of(width, height)) {
    map.at(x, y) = static_cast<float>(lines ? y : x);
  }
  return map;
}

// Maps that count pixels tell which of them was taken: the nearest one, to a few hundredths, or
// beyond the rectified image that of its outline.
TEST(PhotographGrid, PhotographPixelsHaveTheNearestRectifiedPixelsDisparity) {
  std::mt19937 random(1);
  int inside = 0;
  int beyond = 0;
  for (const auto& [width, height, coefficients] :
       {std::array{160, 121, 5}, {131, 17, 14}, {37, 43, 8}}) {
    const Rectifier rectifier(random_calibration(random, width, height, coefficients), width,
                              height);
    const PhotographGrid grid(rectifier, execution());
    for (const Side side : {Side::kLeft, Side::kRight}) {
      Image<float> columns;
      Image<float> lines;
      grid.bring(side, counting_map(width, height, false).view(), columns);
      grid.bring(side, counting_map(width, height, true).view(), lines);
      for (const auto [x, y] : positions_of(width, height)) {
        const auto exact = rectifier.rectified_position(side, {x, y});
        ASSERT_TRUE(exact);
        const bool is_inside = exact->x() >= 0 && exact->x() <= width - 1 && exact->y() >= 0 &&
                               exact->y() <= height - 1;
        ++(is_inside ? inside : beyond);
        ASSERT_NEAR(columns.at(x, y), std::clamp(exact->x(), 0.0, width - 1.0), kHalf);
        ASSERT_NEAR(lines.at(x, y), std::clamp(exact->y(), 0.0, height - 1.0), kHalf);
      }
    }
  }
  EXPECT_GT(inside, 20000);
  EXPECT_GT(beyond, 500);
}

TEST(PhotographGrid, UnknownStaysUnknown) {
  std::mt19937 random(2);
  const Rectifier rectifier(random_calibration(random, 40, 30, 4), 40, 30);
  DisparityMap map(40, 30);
  map.fill(std::numeric_limits<float>::quiet_NaN());
  Image<float> result;
  PhotographGrid(rectifier, execution()).bring(Side::kRight, map.view(), result);
  for (int y = 0; y < 30; ++y) {
    EXPECT_TRUE(
        std::all_of(result.row(y), result.row(y) + 40, [](float d) { return std::isnan(d); }));
  }
}

// Where the polynomial folds back nothing can be said of a pixel, and its neighbours are not drawn
// in by it.
TEST(PhotographGrid, PixelsThatNoRayReachesAreUnknown) {
  constexpr int kSize = 96;
  StereoCalibration rig;
  rig.left.matrix << 40, 0, 47, 0, 40, 47, 0, 0, 1;
  rig.left.distortion = {-0.3, 0, 0, 0};
  rig.right = rig.left;
  rig.translation = {-1, 0, 0};
  const Rectifier rectifier(rig, kSize, kSize);
  Image<float> columns;
  PhotographGrid(rectifier, execution())
      .bring(Side::kLeft, counting_map(kSize, kSize, false).view(), columns);
  int unknown = 0;
  for (const auto [x, y] : positions_of(kSize, kSize)) {
    const auto exact = rectifier.rectified_position(Side::kLeft, {x, y});
    ASSERT_EQ(std::isnan(columns.at(x, y)), !exact.has_value());
    if (exact) {
      ASSERT_NEAR(columns.at(x, y), std::clamp(exact->x(), 0.0, kSize - 1.0), kHalf);
    }
    unknown += exact ? 0 : 1;
  }
  EXPECT_GT(unknown, 100);
}

TEST(PhotographGrid, IsTheSameForEveryExecutorAndKeepsItsMemory) {
  std::mt19937 random(3);
  const Rectifier rectifier(random_calibration(random, 131, 77, 5), 131, 77);
  const DisparityMap map = counting_map(131, 77, false);
  expect_equal_for_every_execution([&](Execution& execution) {
    const PhotographGrid grid(rectifier, execution);
    Image<float> result;
    grid.bring(Side::kLeft, map.view(), result);
    const float* memory = result.row(0);
    grid.bring(Side::kLeft, map.view(), result);
    EXPECT_EQ(result.row(0), memory);
    return values_of(result);
  });
}

TEST(PhotographGrid, RefusesAMapOfAnotherSize) {
  std::mt19937 random(4);
  const Rectifier rectifier(random_calibration(random, 40, 30, 4), 40, 30);
  const PhotographGrid grid(rectifier, execution());
  Image<float> result;
  EXPECT_THAT(
      error_of([&] { grid.bring(Side::kLeft, counting_map(41, 30, false).view(), result); }),
      HasSubstr("is 41x30, expected 40x30"));
}

}  // namespace vantage::photograph_grid_test
