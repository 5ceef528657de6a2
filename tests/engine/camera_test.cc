#include "engine/rectification/camera.h"

#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"

namespace vantage::camera_test {

TEST(LensModel, IsTheFormulaOfItsCoefficients) {
  std::mt19937 random(1);
  for (const int coefficients : {0, 4, 5, 8, 12, 14}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Camera camera = random_camera(random, 640, 480, coefficients);
      const LensModel lens(camera);
      for (int i = 0; i < 50; ++i) {
        const double x = uniform(random, -0.5, 0.5);
        const double y = uniform(random, -0.4, 0.4);
        const auto position = lens.position_of({x, y});
        ASSERT_TRUE(position);
        EXPECT_LT((*position - plain_projection(camera, x, y)).norm(), 1e-9)
            << coefficients << " coefficients at " << x << ", " << y;
      }
    }
  }
}

TEST(LensModel, RaysAreTheInverse) {
  std::mt19937 random(2);
  for (const int coefficients : {0, 4, 5, 8, 12, 14}) {
    for (int trial = 0; trial < 20; ++trial) {
      const LensModel lens(random_camera(random, 640, 480, coefficients));
      for (int i = 0; i < 50; ++i) {
        const Eigen::Vector2d ray(uniform(random, -0.6, 0.6), uniform(random, -0.5, 0.5));
        const auto position = lens.position_of(ray);
        ASSERT_TRUE(position);
        const auto again = lens.ray_of(*position);
        ASSERT_TRUE(again) << coefficients << " coefficients";
        EXPECT_LT((*again - ray).norm(), 1e-8);
      }
    }
  }
}

TEST(LensModel, EndsWhereItsPolynomialFoldsBack) {
  Camera camera;
  camera.matrix << 500, 0, 320, 0, 500, 240, 0, 0, 1;
  camera.distortion = {-0.4, 0, 0, 0};
  const LensModel lens(camera);
  // r − 0.4 r³ is largest at r = 1/√1.2.
  EXPECT_NEAR(lens.largest_ray(), 1 / std::sqrt(1.2), 0.003);
  EXPECT_TRUE(lens.position_of({0.9, 0}));
  EXPECT_FALSE(lens.position_of({0.92, 0}));
  EXPECT_FALSE(lens.position_of({0.7, -0.7}));
  EXPECT_FALSE(lens.position_of({std::nan(""), 0}));
  // The largest distorted radius is 0.6086: pixel 624.3. Beyond it there is nothing to be found.
  EXPECT_TRUE(lens.ray_of({620, 240}));
  EXPECT_FALSE(lens.ray_of({640, 240}));

  camera.distortion = {0, 0, 0, 0, 0, -0.5, 0, 0};  // a pole at r = √2
  EXPECT_LT(LensModel(camera).largest_ray(), 1.4143);
  EXPECT_GT(LensModel(camera).largest_ray(), 1.40);
}

TEST(Camera, RefusesWhatIsNoCamera) {
  const auto error_with = [](const auto& change) {
    Camera camera;
    camera.matrix << 500, 0, 320, 0, 500, 240, 0, 0, 1;
    change(camera);
    return error_of([&] { camera.validate("left camera"); });
  };
  EXPECT_EQ(error_with([](Camera&) {}), "");
  EXPECT_EQ(error_with([](Camera& c) { c.matrix(0, 0) = -1; }),
            "the left camera's fx is -1, expected a focal length of 0.001 to 1e7 pixels");
  EXPECT_NE(error_with([](Camera& c) { c.matrix(1, 1) = 0; }).find("fy is 0"), std::string::npos);
  EXPECT_EQ(error_with([](Camera& c) { c.matrix(2, 2) = 2; }),
            "the left camera's matrix is not of the form fx s cx, 0 fy cy, 0 0 1");
  EXPECT_NE(error_with([](Camera& c) { c.matrix(0, 2) = std::nan(""); }).find("finite"),
            std::string::npos);
  EXPECT_EQ(error_with([](Camera& c) { c.distortion.resize(3); }),
            "the left camera has 3 distortion coefficients, expected 0, 4, 5, 8, 12 or 14");
  EXPECT_NE(error_with([](Camera& c) {
              c.distortion = {0, 0, 0, std::nan("")};
            }).find("nan"),
            std::string::npos);
}

}  // namespace vantage::camera_test
