#include "engine/view_geometry/view_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "engine/error.h"
#include "tests/engine/calibration_cases.h"
#include "tests/engine/io_test_support.h"

namespace vantage {
namespace {

using test::error_of;
using test::random_rotation;
using test::uniform;

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

TEST(ViewPose, PathsStandStillOutsideTheirKeys) {
  const ViewPath path{{{2, BaselinePosition{0, 1}}, {6, BaselinePosition{1, 3}}}};
  path.validate();
  EXPECT_EQ(path.frames(), 7);
  EXPECT_EQ(std::get<BaselinePosition>(path.at(0)), (BaselinePosition{0, 1}));
  EXPECT_EQ(std::get<BaselinePosition>(path.at(2)), (BaselinePosition{0, 1}));
  EXPECT_EQ(std::get<BaselinePosition>(path.at(3)), (BaselinePosition{0.25, 1.5}));
  EXPECT_EQ(std::get<BaselinePosition>(path.at(6)), (BaselinePosition{1, 3}));
  EXPECT_EQ(std::get<BaselinePosition>(path.at(60)), (BaselinePosition{1, 3}));
}

TEST(ViewPose, PathsOfTwoKindsAreRefused) {
  std::mt19937 random(2);
  EXPECT_EQ(error_of([] { ViewPath{}.validate(); }),
            "view path is empty, expected at least one pose");
  const ViewPath repeated{{{3, BaselinePosition{}}, {3, BaselinePosition{}}}};
  EXPECT_EQ(error_of([&] { repeated.validate(); }),
            "view path has frame 3 as key 2, expected frames from 0 that grow from key to key");
  const ViewPath mixed{{{0, BaselinePosition{}}, {1, some_camera(random)}}};
  EXPECT_EQ(error_of([&] { mixed.validate(); }),
            "view path has positions on the baseline and cameras, expected poses of one kind");
  PosedCamera larger = some_camera(random);
  larger.width_px = 100;
  const ViewPath sizes{{{0, some_camera(random)}, {1, larger}}};
  EXPECT_EQ(error_of([&] { sizes.validate(); }),
            "view path has cameras of 64×48 and 100×48, expected one size");
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

TEST(ViewPose, CamerasNeedACalibratedPair) {
  std::mt19937 random(4);
  EXPECT_THROW(new_view(some_camera(random), nullptr, 4, 4), UsageError);
  EXPECT_EQ(new_view(BaselinePosition{0.5, 0.5}, nullptr, 4, 3).height_px, 3);
}

}  // namespace
}  // namespace vantage
