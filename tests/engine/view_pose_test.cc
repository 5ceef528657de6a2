#include "engine/view_geometry/view_pose.h"

#include <Eigen/Dense>

#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"

namespace vantage::view_pose_test {

PosedCamera some_camera(std::mt19937& random) {
  PosedCamera camera{.width_px = 64, .height_px = 48};
  camera.matrix << uniform(random, 50, 90), 0, 31, 0, uniform(random, 50, 90), 22, 0, 0, 1;
  camera.rotation = random_rotation(random, 0.5);
  camera.translation = Eigen::Vector3d::Random();
  return camera;
}

TEST(ViewPose, CamerasMoveStraightAndTurnEvenly) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const PosedCamera from = some_camera(random);
    const PosedCamera to = some_camera(random);
    const double whole = Eigen::AngleAxisd(from.rotation.transpose() * to.rotation).angle();
    for (const double share : {0.0, 0.3, 1.0}) {
      const auto camera = std::get<PosedCamera>(pose_between(from, to, share));
      camera.validate("camera");
      const Eigen::Vector3d centre = (1 - share) * from.centre() + share * to.centre();
      EXPECT_LT((camera.centre() - centre).norm(), 1e-12);
      EXPECT_LT((camera.matrix - (1 - share) * from.matrix - share * to.matrix).norm(), 1e-12);
      EXPECT_NEAR(Eigen::AngleAxisd(from.rotation.transpose() * camera.rotation).angle(),
                  share * whole, 1e-7);
      EXPECT_NEAR(Eigen::AngleAxisd(camera.rotation.transpose() * to.rotation).angle(),
                  (1 - share) * whole, 1e-7);
    }
  }
}

TEST(ViewPose, EyesLieOnTheCamerasOwnXAxis) {
  std::mt19937 random(5);
  const PosedCamera camera = some_camera(random);
  const auto moved = std::get<PosedCamera>(moved_right(camera, 0.5, 3));
  EXPECT_EQ(moved.rotation, camera.rotation);
  const Eigen::Vector3d step = moved.centre() - camera.centre();
  EXPECT_LT((step - 1.5 * camera.rotation.row(0).transpose()).norm(), 1e-12);
  EXPECT_EQ(std::get<BaselinePosition>(moved_right(BaselinePosition{0.25, 1}, 0.5, 3)),
            (BaselinePosition{0.75, 1}));
}

TEST(ViewPose, OrbitsGoRoundTheMiddle) {
  const auto positions = orbit(0.5, 4);
  const double expected[4][2] = {{1, 0}, {0.5, -0.5}, {0, 0}, {0.5, 0.5}};
  ASSERT_EQ(positions.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(positions[i].x, expected[i][0], 1e-15);
    EXPECT_NEAR(positions[i].y, expected[i][1], 1e-15);
  }
}

TEST(ViewPose, ATurnedCameraKeepsItsPointInTheMiddle) {
  std::mt19937 random(3);
  RectifiedPair pair;
  pair.width_px = 640;
  pair.height_px = 480;
  pair.baseline = 0.2;
  pair.doffs_px = 12;
  pair.left.matrix << 700, 0, 310, 0, 700, 250, 0, 0, 1;
  for (int trial = 0; trial < 20; ++trial) {
    const BaselinePosition position{uniform(random, -2, 3), uniform(random, -2, 2)};
    const PosedCamera camera = camera_looking_at(pair, position, 30);
    camera.validate("camera");
    EXPECT_LT((camera.centre() - 0.2 * Eigen::Vector3d(position.x, position.y, 0)).norm(), 1e-12);
    EXPECT_NEAR(camera.rotation(0, 1), 0, 1e-15) << "rolled";
    const NewView view = camera_view(pair, camera);
    // The view half-way sees the point at the principal point: half a disparity left of the left's.
    const Eigen::Vector3d seen =
        view.from_left.homography * Eigen::Vector3d(310 + (30 + 12) / 2.0, 250, 1) +
        30 * view.from_left.parallax;
    EXPECT_NEAR(seen.x() / seen.z(), 310, 1e-9);
    EXPECT_NEAR(seen.y() / seen.z(), 250, 1e-9);
    EXPECT_GT(seen.z(), 0);
  }
  EXPECT_TRUE(camera_looking_at(pair, {0.5, 0}, 30).rotation.isIdentity(1e-15));
  EXPECT_THROW(camera_looking_at(pair, {0, 0}, -12), UsageError);
}

TEST(ViewPose, WhatIsLeftOpenIsFilledIn) {
  std::mt19937 random(6);
  RectifiedPair pair;
  pair.width_px = 64;
  pair.height_px = 48;
  pair.baseline = 2;
  pair.left.matrix << 70, 0, 31, 0, 70, 22, 0, 0, 1;
  const PosedCamera camera = some_camera(random);
  EXPECT_EQ(placed(camera, 5, nullptr, 9, 7), ViewPose(camera));
  PosedCamera sizeless = camera;
  sizeless.width_px = 0;
  sizeless.height_px = 0;
  EXPECT_EQ(placed(sizeless, {}, nullptr, 64, 48), ViewPose(camera));
  const BaselinePosition position{0.25, -1};
  EXPECT_EQ(placed(position, {}, &pair, 9, 7), ViewPose(position));
  EXPECT_EQ(placed(position, 5, &pair, 9, 7), ViewPose(camera_looking_at(pair, position, 5)));
  EXPECT_THROW(placed(position, 5, nullptr, 9, 7), UsageError);
}

TEST(ViewPose, CamerasNeedACalibratedPair) {
  std::mt19937 random(4);
  EXPECT_THROW(new_view(some_camera(random), nullptr, 4, 4), UsageError);
  EXPECT_EQ(new_view(BaselinePosition{0.5, 0.5}, nullptr, 4, 3).height_px, 3);
}

}  // namespace vantage::view_pose_test
