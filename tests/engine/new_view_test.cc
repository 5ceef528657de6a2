#include "engine/view_geometry/new_view.h"

#include <Eigen/Dense>

#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"

namespace vantage::new_view_test {

RectifiedPair random_pair(std::mt19937& random) {
  RectifiedPair pair;
  pair.width_px = 640;
  pair.height_px = 480;
  pair.baseline = uniform(random, 0.05, 200);
  pair.doffs_px = uniform(random, -30, 30);
  pair.left.matrix << 700, 0, 310, 0, 690, 250, 0, 0, 1;
  pair.right.matrix = pair.left.matrix;
  pair.right.matrix(0, 2) += pair.doffs_px;
  return pair;
}

// What a camera sees of a point of the left camera's frame, and its depth.
Eigen::Vector3d plain_projection(const PosedCamera& camera, const Eigen::Vector3d& point) {
  const Eigen::Vector3d seen = camera.matrix * (camera.rotation * point + camera.translation);
  return {seen.x() / seen.z(), seen.y() / seen.z(), seen.z()};
}

Eigen::Vector3d apply(const ViewWarp& warp, double x, double y, double disparity_px) {
  const Eigen::Vector3d seen =
      warp.homography * Eigen::Vector3d(x, y, 1) + disparity_px * warp.parallax;
  return {seen.x() / seen.z(), seen.y() / seen.z(), seen.z()};
}

TEST(NewView, CameraSeesThePointsOfThePair) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const RectifiedPair pair = random_pair(random);
    PosedCamera camera;
    camera.matrix << uniform(random, 300, 1500), uniform(random, -2, 2), 300, 0, 900, 200, 0, 0, 1;
    camera.rotation = random_rotation(random, 0.4);
    camera.translation = 3 * pair.baseline * Eigen::Vector3d::Random();
    camera.width_px = 501;
    camera.height_px = 303;
    const NewView view = camera_view(pair, camera);
    EXPECT_EQ(view.width_px, 501);
    EXPECT_EQ(view.height_px, 303);
    const Eigen::Vector3d right_centre(pair.baseline, 0, 0);
    EXPECT_NEAR(view.distance_from_left, camera.centre().norm() / pair.baseline, 1e-12);
    EXPECT_NEAR(view.distance_from_right, (camera.centre() - right_centre).norm() / pair.baseline,
                1e-12);
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d point =
          pair.baseline *
          Eigen::Vector3d(uniform(random, -6, 6), uniform(random, -6, 6), uniform(random, 5, 60));
      const Eigen::Vector3d left = (pair.left.matrix * point) / point.z();
      const Eigen::Vector3d right = (pair.right.matrix * (point - right_centre)) / point.z();
      const double disparity_px = left.x() - right.x();
      const Eigen::Vector3d expected = plain_projection(camera, point);
      const Eigen::Vector3d from_left = apply(view.from_left, left.x(), left.y(), disparity_px);
      const Eigen::Vector3d from_right = apply(view.from_right, right.x(), right.y(), disparity_px);
      const double scale = 1 + expected.head<2>().norm();
      EXPECT_NEAR((from_left - from_right).norm(), 0, 1e-9 * scale);
      EXPECT_NEAR((from_left.head<2>() - expected.head<2>()).norm(), 0, 1e-8 * scale);
      // Nearness is the disparity that the pair sees at that depth.
      EXPECT_NEAR(from_left.z(), expected.z() / point.z(), 1e-9 * std::abs(expected.z()));
      const double nearness = (disparity_px - view.infinity_disparity_px) / from_left.z();
      EXPECT_NEAR(nearness * expected.z(), pair.left.matrix(0, 0) * pair.baseline,
                  1e-6 * pair.baseline * (1 + std::abs(nearness)));
    }
  }
}

TEST(NewView, BaselineViewsAreTranslations) {
  const NewView view = baseline_view(0.25, -0.5, 7, 5);
  EXPECT_TRUE(view.from_left.is_translation());
  EXPECT_TRUE(view.from_right.is_translation());
  EXPECT_EQ(apply(view.from_left, 3, 2, 4), Eigen::Vector3d(2, 4, 1));
  EXPECT_EQ(apply(view.from_right, 3, 2, 4), Eigen::Vector3d(6, 4, 1));
  EXPECT_DOUBLE_EQ(view.alpha(),
                   std::hypot(0.75, 0.5) / (std::hypot(0.75, 0.5) + std::hypot(0.25, 0.5)));
  EXPECT_EQ(baseline_view(0, 0, 1, 1).alpha(), 1);
  EXPECT_EQ(baseline_view(1, 0, 1, 1).alpha(), 0);
}

TEST(NewView, ACameraLikeThePairsIsItsBaselineView) {
  std::mt19937 random(4);
  RectifiedPair pair = random_pair(random);
  pair.doffs_px = 0;
  pair.right.matrix = pair.left.matrix;
  PosedCamera camera{.matrix = pair.left.matrix, .width_px = 640, .height_px = 480};
  // In the pair's pixels fy takes the place of fx downwards.
  camera.translation = -pair.baseline * Eigen::Vector3d(0.25, -0.5, 0);
  const NewView view = camera_view(pair, camera);
  EXPECT_LT((view.from_left.homography - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_LT((view.from_left.parallax - Eigen::Vector3d(-0.25, 0.5 * 690 / 700, 0)).norm(), 1e-12);
}

TEST(NewView, RefusesWhatCannotBeSeen) {
  std::mt19937 random(5);
  const RectifiedPair pair = random_pair(random);
  PosedCamera good{.matrix = pair.left.matrix, .width_px = 640, .height_px = 480};
  EXPECT_NO_THROW(camera_view(pair, good));

  PosedCamera far = good;
  far.translation = Eigen::Vector3d(0, 18 * pair.baseline, 0);
  EXPECT_EQ(error_of([&] { camera_view(pair, far); }),
            "camera of the new view is 18 baselines from the left camera, expected at most 16");

  PosedCamera backward = good;
  backward.rotation = Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY());
  EXPECT_NE(error_of([&] { camera_view(pair, backward); }).find("looks away"), std::string::npos);

  PosedCamera mirrored = good;
  mirrored.rotation(0, 0) = -1;
  EXPECT_NE(error_of([&] { camera_view(pair, mirrored); }).find("mirrored"), std::string::npos);

  PosedCamera skewed = good;
  skewed.rotation(0, 1) = 0.01;
  EXPECT_NE(error_of([&] { camera_view(pair, skewed); }).find("R Rᵀ differs from the identity by"),
            std::string::npos);

  PosedCamera flat = good;
  flat.matrix(1, 1) = 0;
  EXPECT_NE(error_of([&] { camera_view(pair, flat); }).find("focal lengths are 700 and 0 px"),
            std::string::npos);

  PosedCamera empty = good;
  empty.width_px = 0;
  EXPECT_NE(error_of([&] { camera_view(pair, empty); }).find("image is 0×480"), std::string::npos);

  EXPECT_THROW(baseline_view(17, 0, 4, 4), UsageError);
  EXPECT_THROW(baseline_view(0, std::nan(""), 4, 4), UsageError);
}

}  // namespace vantage::new_view_test
