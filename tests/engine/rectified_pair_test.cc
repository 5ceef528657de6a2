#include "engine/rectification/rectified_pair.h"

#include <Eigen/Dense>

#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"

namespace vantage::rectified_pair_test {

/// Where a rectified pixel lies in the photograph, step by step.
Eigen::Vector2d plain_source(const RectifiedCamera& rectified, const Camera& camera, double x,
                             double y) {
  const double u = (x - rectified.matrix(0, 2)) / rectified.matrix(0, 0);
  const double v = (y - rectified.matrix(1, 2)) / rectified.matrix(1, 1);
  const Eigen::Vector3d ray = rectified.rotation.inverse() * Eigen::Vector3d(u, v, 1);
  return plain_projection(camera, ray.x() / ray.z(), ray.y() / ray.z());
}

bool is_in_image(const Eigen::Vector2d& position, int width, int height, double margin) {
  return position.x() >= -margin && position.x() <= width - 1 + margin && position.y() >= -margin &&
         position.y() <= height - 1 + margin;
}

TEST(RectifiedPair, RowsCorrespondAndDisparityIsInverseDepth) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 16; ++trial) {
    const int coefficients = trial % 2 == 0 ? 0 : 5;
    const StereoCalibration rig = random_calibration(random, 640, 480, coefficients, 0.15);
    const RectifiedPair pair = rectified_pair(rig, 640, 480);
    EXPECT_EQ(pair.left.matrix, pair.right.matrix);
    EXPECT_EQ(pair.left.matrix(0, 0), pair.left.matrix(1, 1));
    EXPECT_EQ(pair.doffs_px, 0);
    EXPECT_NEAR(pair.baseline, rig.translation.norm(), 1e-15);
    for (const RectifiedCamera& camera : {pair.left, pair.right}) {
      EXPECT_LT((camera.rotation * camera.rotation.transpose() - Eigen::Matrix3d::Identity())
                    .cwiseAbs()
                    .maxCoeff(),
                1e-12);
      EXPECT_NEAR(camera.rotation.determinant(), 1, 1e-12);
    }
    for (int i = 0; i < 50; ++i) {
      const double z = uniform(random, 5, 100) * pair.baseline;
      const Eigen::Vector3d in_left(uniform(random, -0.4, 0.4) * z, uniform(random, -0.3, 0.3) * z,
                                    z);
      const Eigen::Vector3d in_right = rig.rotation * in_left + rig.translation;
      const auto pixel = [](const RectifiedCamera& camera, const Camera& source,
                            const Eigen::Vector3d& point) {
        const Eigen::Vector3d turned = camera.matrix * camera.rotation * point;
        // The homography says the same of the pixel in the photograph freed of its distortion.
        const Eigen::Vector3d warped = camera.homography * (source.matrix * point / point.z());
        EXPECT_LT((turned.hnormalized() - warped.hnormalized()).norm(), 1e-8);
        return Eigen::Vector2d(turned.hnormalized());
      };
      const Eigen::Vector2d left = pixel(pair.left, rig.left, in_left);
      const Eigen::Vector2d right = pixel(pair.right, rig.right, in_right);
      EXPECT_NEAR(left.y(), right.y(), 1e-9);
      const double depth = (pair.left.rotation * in_left).z();
      EXPECT_NEAR(left.x() - right.x(), pair.left.matrix(0, 0) * pair.baseline / depth, 1e-9);
    }
  }
}

TEST(RectifiedPair, BothCamerasTurnAboutEquallyFar) {
  StereoCalibration rig;
  rig.left.matrix << 600, 0, 320, 0, 600, 240, 0, 0, 1;
  rig.right = rig.left;
  // Both look 4 degrees inwards.
  const double angle = 8 * 3.14159265358979 / 180;
  rig.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  rig.translation =
      -(Eigen::AngleAxisd(angle / 2, Eigen::Vector3d::UnitY()) * Eigen::Vector3d::UnitX());
  const RectifiedPair pair = rectified_pair(rig, 640, 480);
  EXPECT_NEAR(Eigen::AngleAxisd(pair.left.rotation).angle(), angle / 2, 1e-9);
  EXPECT_NEAR(Eigen::AngleAxisd(pair.right.rotation).angle(), angle / 2, 1e-9);
}

TEST(RectifiedPair, ByDefaultEveryPixelIsSeenAndTheWindowIsAsLargeAsCanBe) {
  std::mt19937 random(2);
  for (const auto& [width, height] : {std::pair{64, 48}, {31, 97}, {97, 31}}) {
    for (const int coefficients : {0, 5, 8, 14}) {
      const StereoCalibration rig = random_calibration(random, width, height, coefficients);
      const RectifiedPair pair = rectified_pair(rig, width, height);
      EXPECT_EQ(pair.valid.width, width);
      EXPECT_EQ(pair.valid.height, height);
      // Nearest that the edge of the rectified images comes to the edge of a photograph.
      double nearest = 1e9;
      for (const auto& [rectified, source] :
           {std::pair{&pair.left, &rig.left}, std::pair{&pair.right, &rig.right}}) {
        for (double y = -0.5; y < height; y += 0.5) {
          for (double x = -0.5; x < width; x += 0.5) {
            const Eigen::Vector2d p = plain_source(*rectified, *source, x, y);
            ASSERT_TRUE(is_in_image(p, width, height, 0.51))
                << width << "x" << height << ", " << coefficients << ": " << p.transpose();
            nearest = std::min(
                {nearest, p.x() + 0.5, width - 0.5 - p.x(), p.y() + 0.5, height - 0.5 - p.y()});
          }
        }
      }
      EXPECT_LT(nearest, 0.02);
    }
  }
}

TEST(RectifiedPair, MayKeepTheWholeOutline) {
  std::mt19937 random(3);
  for (const int coefficients : {0, 5, 14}) {
    const int width = 96;
    const int height = 72;
    const StereoCalibration rig = random_calibration(random, width, height, coefficients);
    const RectifiedPair pair = rectified_pair(rig, width, height, {.kept_outline = 1});
    const RectifiedPair cropped = rectified_pair(rig, width, height);
    EXPECT_LT(pair.left.matrix(0, 0), cropped.left.matrix(0, 0));
    EXPECT_GT(pair.valid.width, width / 2);
    EXPECT_LT(pair.valid.width, width);
    for (const auto& [rectified, source] :
         {std::pair{&pair.left, &rig.left}, std::pair{&pair.right, &rig.right}}) {
      // Along the edges of a photograph, where nothing of it may be lost.
      const LensModel lens(*source);
      for (int i = 0; i <= 40; ++i) {
        const double x = -0.5 + width * i / 40.0;
        const double y = -0.5 + height * i / 40.0;
        for (const Eigen::Vector2d& edge :
             {Eigen::Vector2d(x, -0.5), Eigen::Vector2d(x, height - 0.5), Eigen::Vector2d(-0.5, y),
              Eigen::Vector2d(width - 0.5, y)}) {
          const auto ray = lens.ray_of(edge);
          ASSERT_TRUE(ray);
          const Eigen::Vector2d p =
              (rectified->matrix * rectified->rotation * ray->homogeneous()).hnormalized();
          EXPECT_TRUE(is_in_image(p, width, height, 0.52)) << p.transpose();
        }
      }
      // The valid part shows nothing that lies outside.
      for (const auto [x, y] : positions_of({pair.valid.x, pair.valid.x + pair.valid.width},
                                            {pair.valid.y, pair.valid.y + pair.valid.height})) {
        ASSERT_TRUE(is_in_image(plain_source(*rectified, *source, x, y), width, height, 0.51));
      }
    }
    const RectifiedPair between = rectified_pair(rig, width, height, {.kept_outline = 0.5});
    EXPECT_NEAR(2 / between.left.matrix(0, 0),
                1 / pair.left.matrix(0, 0) + 1 / cropped.left.matrix(0, 0), 1e-9);
  }
}

TEST(RectifiedPair, CamerasThatAreRectifiedAlreadyStayAsTheyAre) {
  StereoCalibration rig;
  rig.left.matrix << 500, 0, 310, 0, 500, 245, 0, 0, 1;
  rig.right = rig.left;
  rig.translation = {-0.2, 0, 0};
  const RectifiedPair computed = rectified_pair(rig, 640, 480);
  EXPECT_LT((computed.left.matrix - rig.left.matrix).cwiseAbs().maxCoeff(), 1e-2);
  EXPECT_LT((computed.left.rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-12);

  rig.is_rectified = true;
  rig.right.matrix(0, 2) = 330;
  const RectifiedPair passed_on = rectified_pair(rig, 640, 480);
  EXPECT_EQ(passed_on.left.matrix, rig.left.matrix);
  EXPECT_EQ(passed_on.right.matrix, rig.right.matrix);
  EXPECT_EQ(passed_on.doffs_px, 20);
  EXPECT_EQ(passed_on.baseline, 0.2);
  EXPECT_EQ(passed_on.valid.width, 640);
}

TEST(RectifiedPair, RefusesCamerasThatCannotBeRectified) {
  StereoCalibration rig;
  rig.left.matrix << 500, 0, 320, 0, 500, 240, 0, 0, 1;
  rig.right = rig.left;
  const auto error_with = [&](const Eigen::Vector3d& translation, double turned_degrees,
                              int width = 640) {
    StereoCalibration changed = rig;
    changed.translation = translation;
    changed.rotation =
        Eigen::AngleAxisd(turned_degrees * 3.14159265358979 / 180, Eigen::Vector3d::UnitY());
    return error_of([&] { rectified_pair(changed, width, 480); });
  };
  EXPECT_EQ(error_with({-1, 0, 0}, 0), "");
  EXPECT_EQ(error_with({1, 0, 0}, 0),
            "the right camera is to the left of the left one, expected the cameras swapped");
  EXPECT_EQ(error_with({0, -1, 0}, 0),
            "the baseline is turned 90.0 degrees from the cameras' x axes, limit 45: expected "
            "cameras side by side");
  EXPECT_THAT(error_with({-0.5, 0, -1}, 0), HasSubstr("63.4 degrees"));
  EXPECT_EQ(error_with({-1, 0, 0}, 100),
            "the cameras' viewing directions are 100.0 degrees apart, limit 90");
  // Each looks 30 degrees inwards and sees 33 to the side.
  EXPECT_THAT(error_with({-std::sqrt(0.75), 0, 0.5}, 60), HasSubstr("common view"));
  EXPECT_THAT(error_with({-1, 0, 0}, 0, 300), HasSubstr("principal point"));
  // Distortion that folds back at once: the camera sees nothing.
  StereoCalibration folded = rig;
  folded.right.distortion = {-1e6, 0, 0, 0};
  EXPECT_NE(error_of([&] { rectified_pair(folded, 640, 480); }).find("common view is 0.0 %"),
            std::string::npos);
  EXPECT_EQ(error_of([&] { rectified_pair(rig, 640, 480, {.kept_outline = 1.5}); }),
            "kept-outline is 1.5, expected 0 to 1");
}

}  // namespace vantage::rectified_pair_test
