#include "engine/view_geometry/depth_resolution.h"

#include "tests/engine/engine_test.h"

namespace vantage::depth_resolution_test {

/// The example of (4.2): 640 pixels over 50 degrees, a baseline of 50 mm, a resolution of a pixel.
TEST(DepthResolution, IsThatOfTheBooksExample) {
  const DepthScale scale{.focal_length_px = 686, .baseline = 0.05};
  const auto at = [&](double depth_m) {
    return *depth_resolution(scale, 1, scale.focal_length_px * scale.baseline / depth_m);
  };
  EXPECT_NEAR(at(0.5), 0.0073, 0.0002);               // "7.3 mm"
  EXPECT_NEAR(at(5) / (1 + at(5) / 5), 0.73, 0.005);  // "0.73 m", to first order
}

TEST(DepthResolution, SolvesTheEquation) {
  const DepthScale scale{.focal_length_px = 994, .baseline = 193, .doffs_px = 31.1};
  for (const double disparity_px : {0.0, 7.25, 60.0, -30.5}) {
    for (const double step_px : {0.1, 0.5}) {
      const double z = 994 * 193 / (disparity_px + 31.1);
      EXPECT_DOUBLE_EQ(*depth(scale, disparity_px), z);
      const double step = *depth_resolution(scale, step_px, disparity_px);
      EXPECT_NEAR(step, step_px / (994.0 * 193) * z * (z + step), 1e-9 * step);
      EXPECT_NEAR(z + step, *depth(scale, disparity_px - step_px), 1e-9 * z);
    }
  }
  EXPECT_FALSE(depth(scale, -31.1));
  EXPECT_FALSE(depth_resolution(scale, 0.5, -30.6));
  EXPECT_FALSE(depth_resolution(scale, 0.5, -40));
}

TEST(DepthResolution, OfAMapIsThatOfItsPixels) {
  const DepthScale scale{.focal_length_px = 500, .baseline = 2};
  DisparityMap map(3, 2);
  map.fill(20);
  map.at(1, 0) = std::numeric_limits<float>::quiet_NaN();
  map.at(2, 0) = 0.0625F;
  map.at(0, 1) = 2;
  Image<float> resolution;
  depth_resolution_map(map.view(), scale, 0.125, execution(), resolution);
  EXPECT_FLOAT_EQ(resolution.at(0, 0), static_cast<float>(*depth_resolution(scale, 0.125, 20)));
  EXPECT_TRUE(std::isnan(resolution.at(1, 0)));
  EXPECT_TRUE(std::isnan(resolution.at(2, 0)));
  EXPECT_FLOAT_EQ(resolution.at(0, 1), static_cast<float>(*depth_resolution(scale, 0.125, 2)));
}

}  // namespace vantage::depth_resolution_test
