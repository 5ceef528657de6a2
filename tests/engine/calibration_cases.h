#pragma once

#include <Eigen/Dense>

#include "engine/rectification/stereo_calibration.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {

/// The lens model as a formula: the pixel of the point (x, y, 1), in double, without any limit.
inline Eigen::Vector2d plain_projection(const Camera& camera, double x, double y) {
  std::vector<double> k = camera.distortion;
  k.resize(14, 0.0);
  const double k1 = k[0], k2 = k[1], p1 = k[2], p2 = k[3], k3 = k[4], k4 = k[5], k5 = k[6];
  const double k6 = k[7], s1 = k[8], s2 = k[9], s3 = k[10], s4 = k[11], tx = k[12], ty = k[13];
  const double r = std::sqrt(x * x + y * y);
  const double r2 = std::pow(r, 2), r4 = std::pow(r, 4), r6 = std::pow(r, 6);
  const double stretch = (1 + k1 * r2 + k2 * r4 + k3 * r6) / (1 + k4 * r2 + k5 * r4 + k6 * r6);
  const double u = x * stretch + 2 * p1 * x * y + p2 * (r2 + 2 * x * x) + s1 * r2 + s2 * r4;
  const double v = y * stretch + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y + s3 * r2 + s4 * r4;
  // The tilted sensor: where the line through the lens' centre and (u, v, 1) meets the plane
  // through (0, 0, 1) whose normal is the tilted axis, in coordinates of that plane.
  const Eigen::Matrix3d tilt = (Eigen::AngleAxisd(-ty, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(-tx, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Eigen::Vector3d seen = tilt * Eigen::Vector3d(u, v, 1);
  const double m = (tilt(2, 2) * seen.x() - tilt(0, 2) * seen.z()) / seen.z();
  const double n = (tilt(2, 2) * seen.y() - tilt(1, 2) * seen.z()) / seen.z();
  return {camera.matrix(0, 0) * m + camera.matrix(0, 1) * n + camera.matrix(0, 2),
          camera.matrix(1, 1) * n + camera.matrix(1, 2)};
}

inline double uniform(std::mt19937& random, double min, double max) {
  return min + (max - min) * static_cast<double>(random()) / 4294967295.0;
}

/// A camera for images of this size, with so many (0, 4, 5, 8, 12, 14) mild coefficients.
inline Camera random_camera(std::mt19937& random, int width, int height, int coefficients) {
  Camera camera;
  const double focal = uniform(random, 0.8, 1.3) * std::max(width, height);
  camera.matrix << focal, 0, width * uniform(random, 0.45, 0.55), 0,
      focal * uniform(random, 0.99, 1.01), height * uniform(random, 0.45, 0.55), 0, 0, 1;
  const double limit[14] = {0.2,  0.08, 2e-3, 2e-3, 0.03, 0.02, 0.02,
                            0.01, 2e-3, 1e-3, 2e-3, 1e-3, 0.02, 0.02};
  for (int i = 0; i < coefficients; ++i) {
    camera.distortion.push_back(uniform(random, -limit[i], limit[i]));
  }
  return camera;
}

inline Eigen::Matrix3d random_rotation(std::mt19937& random, double max_radians) {
  const auto angle = [&] { return uniform(random, -max_radians, max_radians); };
  return (Eigen::AngleAxisd(angle(), Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(angle(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angle(), Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

inline StereoCalibration random_calibration(std::mt19937& random, int width, int height,
                                            int coefficients, double max_radians = 0.08) {
  StereoCalibration calibration;
  calibration.left = random_camera(random, width, height, coefficients);
  calibration.right = random_camera(random, width, height, coefficients);
  calibration.rotation = random_rotation(random, max_radians);
  const double baseline = uniform(random, 0.05, 2);
  calibration.translation =
      baseline * Eigen::Vector3d(-1, uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1));
  return calibration;
}

}  // namespace test
}  // namespace vantage
