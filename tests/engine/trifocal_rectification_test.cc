#include "engine/view_geometry/trifocal_rectification.h"

#include <Eigen/Dense>

#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"

namespace vantage::trifocal_rectification_test {

// A camera at `centre` that looks along the reference frame's Z but for a small turn.
PosedCamera camera_at(std::mt19937& random, const Eigen::Vector3d& centre, double turn) {
  PosedCamera camera;
  camera.matrix << uniform(random, 400, 900), uniform(random, -1, 1), uniform(random, 200, 400), 0,
      uniform(random, 400, 900), uniform(random, 100, 300), 0, 0, 1;
  camera.rotation = random_rotation(random, turn);
  camera.translation = -camera.rotation * centre;
  camera.width_px = 480 + static_cast<int>(uniform(random, 0, 100));
  camera.height_px = 300 + static_cast<int>(uniform(random, 0, 100));
  return camera;
}

Eigen::Vector2d rectified(const TrifocalRectification& rig, const PosedCamera& camera, int number,
                          const Eigen::Vector3d& point) {
  const Eigen::Vector3d pixel = camera.matrix * (camera.rotation * point + camera.translation);
  return (rig.homographies[static_cast<std::size_t>(number)] * pixel).hnormalized();
}

TEST(TrifocalRectification, DisparityTimesPositionMovesPixels) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    // The whole rig is turned, so the reference frame means nothing.
    const Eigen::Matrix3d turn = random_rotation(random, 1.7);
    const double unit = uniform(random, 0.1, 100);
    std::array<PosedCamera, 3> cameras = {
        camera_at(random, {0, 0, 0}, 0.1),
        camera_at(random,
                  unit * Eigen::Vector3d(uniform(random, 0.5, 2), uniform(random, -.2, .2),
                                         uniform(random, -.2, .2)),
                  0.1),
        camera_at(random,
                  unit * Eigen::Vector3d(uniform(random, -2, 3), uniform(random, -2, 2),
                                         uniform(random, -.3, .3)),
                  0.1)};
    if (trial % 4 == 0) {  // on the baseline, where the plane is free
      const Eigen::Vector3d centre = uniform(random, -1, 2) * cameras[1].centre();
      cameras[2].translation = -cameras[2].rotation * centre;
    }
    for (PosedCamera& camera : cameras) {
      camera.rotation = camera.rotation * turn.transpose();
    }
    TrifocalRectification rig;
    try {
      rig = trifocal_rectification(cameras[0], cameras[1], cameras[2]);
    } catch (const Error& error) {  // the plane may come to lie badly
      EXPECT_THAT(std::string(error.what()), HasSubstr("plane through the three cameras"));
      continue;
    }
    if (trial % 4 == 0) {
      EXPECT_NEAR(rig.view_y, 0, 1e-9);
    }
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d point =
          unit * turn *
          Eigen::Vector3d(uniform(random, -4, 4), uniform(random, -4, 4), uniform(random, 8, 60));
      const Eigen::Vector2d first = rectified(rig, cameras[0], 0, point);
      const Eigen::Vector2d second = rectified(rig, cameras[1], 1, point);
      const Eigen::Vector2d view = rectified(rig, cameras[2], 2, point);
      const double d = first.x() - second.x();
      EXPECT_NEAR(second.y(), first.y(), 1e-9);
      const Eigen::Vector2d position(rig.view_x, rig.view_y);
      EXPECT_LT((view - first + d * position).norm(), 1e-9);
      EXPECT_LT((view - second + d * (position - Eigen::Vector2d(1, 0))).norm(), 1e-9);
      const Eigen::Vector3d in_frame = rig.rotation * (point - cameras[0].centre()) / rig.baseline;
      EXPECT_NEAR(d, rig.focal_length_px / in_frame.z(), 1e-8);
    }
  }
}

TEST(TrifocalRectification, HoldsWhatAllThreeCamerasSee) {
  std::mt19937 random(2);
  const std::array<PosedCamera, 3> cameras = {camera_at(random, {0, 0, 0}, 0.1),
                                              camera_at(random, {1, 0.1, 0}, 0.1),
                                              camera_at(random, {0.5, -0.8, 0.1}, 0.1)};
  const TrifocalRectification rig = trifocal_rectification(cameras[0], cameras[1], cameras[2]);
  Eigen::Vector2d min(1e9, 1e9);
  Eigen::Vector2d largest(-1e9, -1e9);
  for (std::size_t i = 0; i < 3; ++i) {
    for (const double x : {-0.5, cameras[i].width_px - 0.5}) {
      for (const double y : {-0.5, cameras[i].height_px - 0.5}) {
        const Eigen::Vector2d corner =
            (rig.homographies[i] * Eigen::Vector3d(x, y, 1)).hnormalized();
        min = min.cwiseMin(corner);
        largest = largest.cwiseMax(corner);
      }
    }
  }
  EXPECT_GE(min.minCoeff(), -0.5 - 1e-5);
  EXPECT_LT(min.maxCoeff(), 0.5);
  EXPECT_LE(largest.x(), rig.width_px - 0.5 + 1e-5);
  EXPECT_GT(largest.x(), rig.width_px - 1.5);
  EXPECT_LE(largest.y(), rig.height_px - 0.5 + 1e-5);
  EXPECT_GT(largest.y(), rig.height_px - 1.5);
}

TEST(TrifocalRectification, KeepsTheResolutionOfRectifiedCameras) {
  PosedCamera camera{.width_px = 640, .height_px = 480};
  camera.matrix << 700, 0, 319.5, 0, 700, 239.5, 0, 0, 1;
  PosedCamera right = camera;
  right.translation = {-2, 0, 0};
  PosedCamera view = camera;
  view.translation = {-1, -1, 0};
  const TrifocalRectification rig = trifocal_rectification(camera, right, view);
  EXPECT_NEAR(rig.focal_length_px, 700, 1e-9);
  EXPECT_NEAR(rig.view_x, 0.5, 1e-12);
  EXPECT_NEAR(rig.view_y, 0.5, 1e-12);
  EXPECT_EQ(rig.width_px, 640);
  EXPECT_EQ(rig.height_px, 480);
  EXPECT_LT((rig.homographies[2] - Eigen::Matrix3d::Identity()).norm(), 1e-9);
}

TEST(TrifocalRectification, NamesWhatIsWrong) {
  PosedCamera camera{.width_px = 640, .height_px = 480};
  camera.matrix << 700, 0, 319.5, 0, 700, 239.5, 0, 0, 1;
  PosedCamera right = camera;
  right.translation = {-1, 0, 0};
  EXPECT_EQ(error_of([&] { trifocal_rectification(camera, camera, right); }),
            "first and second camera are at one place, expected a baseline between them");
  // A camera ahead of the baseline: the plane holds the viewing direction.
  PosedCamera ahead = camera;
  ahead.translation = {-0.5, 0, -1};
  EXPECT_NE(error_of([&] {
              trifocal_rectification(camera, right, ahead);
            }).find("first camera sees as low as -"),
            std::string::npos);
  PosedCamera wide = camera;
  wide.matrix(0, 0) = wide.matrix(1, 1) = 60;
  wide.width_px = wide.height_px = 600;
  PosedCamera sharp = camera;
  sharp.matrix(0, 0) = sharp.matrix(1, 1) = 9000;
  sharp.translation = {-1, 0, 0};
  PosedCamera between = wide;
  between.translation = {-0.5, -0.1, 0};
  between.matrix(0, 2) = between.matrix(1, 2) = 300;
  EXPECT_NE(error_of([&] {
              trifocal_rectification(camera, sharp, between);
            }).find("expected at most 16384 pixels each way"),
            std::string::npos);
}

}  // namespace vantage::trifocal_rectification_test
