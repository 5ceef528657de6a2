#include "engine/scene_graph/cloud_geometry.h"

#include "tests/engine/engine_test.h"

namespace vantage::interpolated_disparity_test {

DisparityMap two_by_two(float upper_left, float upper_right, float lower_left, float lower_right) {
  DisparityMap map(2, 2);
  map.at(0, 0) = upper_left;
  map.at(1, 0) = upper_right;
  map.at(0, 1) = lower_left;
  map.at(1, 1) = lower_right;
  return map;
}

TEST(InterpolatedDisparity, IsBilinearOnOneSurface) {
  const DisparityMap map = two_by_two(3, 4, 3.5F, 3.25F);
  EXPECT_FLOAT_EQ(interpolated_disparity(map.view(), 0.25, 0.5),
                  0.5F * (0.75F * 3 + 0.25F * 4) + 0.5F * (0.75F * 3.5F + 0.25F * 3.25F));
  EXPECT_FLOAT_EQ(interpolated_disparity(map.view(), 1, 1), 3.25F);
}

TEST(InterpolatedDisparity, TakesTheNearestOfTwoSurfacesAndBesideUnknownPixels) {
  const DisparityMap jump = two_by_two(3, 9, 3, 9);
  EXPECT_EQ(interpolated_disparity(jump.view(), 0.49, 0.2), 3);
  EXPECT_EQ(interpolated_disparity(jump.view(), 0.51, 0.2), 9);
  const DisparityMap gap = two_by_two(3, kUnknown, 4, 4);
  EXPECT_EQ(interpolated_disparity(gap.view(), 0.2, 0.2), 3);
  EXPECT_TRUE(std::isnan(interpolated_disparity(gap.view(), 0.8, 0.2)));
}

TEST(InterpolatedDisparity, OnePixelIsThereEverywhere) {
  DisparityMap map(1, 1);
  map.at(0, 0) = 5;
  EXPECT_EQ(interpolated_disparity(map.view(), 0, 0), 5);
}

}  // namespace vantage::interpolated_disparity_test
