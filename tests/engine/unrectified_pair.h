#pragma once

#include <Eigen/Dense>

#include "engine/generation/layered_scene.h"
#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/warped_photograph.h"

namespace vantage {
inline namespace test {

inline Eigen::Matrix3d turned_by(double x, double y, double z) {
  return (Eigen::AngleAxisd(x, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(y, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(z, Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

/// A rendered scene as a pair of cameras sees it that have been turned by some degrees.
struct RenderedPair {
  Photograph left;
  Photograph right;
  StereoCalibration calibration;  ///< the truth; the baseline is 1 long
};

inline RenderedPair unrectified_pair(Execution& execution, int width = 320, int height = 240) {
  LayeredScene scene({.width_px = width, .height_px = height, .samples_per_side = 2}, execution);
  const double focal = scene.focal_length_px();
  RenderedPair pair;
  Camera camera;
  camera.matrix << focal, 0, (width - 1) / 2.0, 0, focal, (height - 1) / 2.0, 0, 0, 1;
  pair.calibration.left = camera;
  pair.calibration.right = camera;
  const Eigen::Matrix3d left_turn = turned_by(0.02, 0.01, -0.03);
  const Eigen::Matrix3d right_turn = turned_by(-0.02, -0.015, 0.02);
  pair.calibration.rotation = right_turn * left_turn.transpose();
  pair.calibration.translation = -right_turn * Eigen::Vector3d::UnitX();
  const auto homography = [&](const Eigen::Matrix3d& turn) {
    return Eigen::Matrix3d(camera.matrix * turn * camera.matrix.inverse());
  };
  pair.left = warped(scene.render({0, 0}, 0).image, homography(left_turn));
  pair.right = warped(scene.render({1, 0}, 0).image, homography(right_turn));
  return pair;
}

}  // namespace test
}  // namespace vantage
