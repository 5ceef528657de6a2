#pragma once

#include <Eigen/Dense>

#include "engine/rectification/feature_matches.h"
#include "tests/engine/calibration_cases.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {

/// Points in front of both cameras that both images show, `nearest` to `furthest` baselines away.
inline std::vector<PointMatch> exact_matches(const StereoCalibration& rig, int width, int height,
                                             int count, std::mt19937& random, double nearest = 5,
                                             double furthest = 60) {
  const auto is_inside = [&](const Eigen::Vector2d& p) {
    return p.x() >= 0 && p.x() <= width - 1 && p.y() >= 0 && p.y() <= height - 1;
  };
  std::vector<PointMatch> matches;
  while (static_cast<int>(matches.size()) < count) {
    const double z = uniform(random, nearest, furthest) * rig.translation.norm();
    const Eigen::Vector3d in_left(uniform(random, -0.8, 0.8) * z, uniform(random, -0.8, 0.8) * z,
                                  z);
    const Eigen::Vector3d in_right = rig.rotation * in_left + rig.translation;
    if (in_right.z() <= 0) {
      continue;
    }
    const PointMatch match{.left = plain_projection(rig.left, in_left.x() / z, in_left.y() / z),
                           .right = plain_projection(rig.right, in_right.x() / in_right.z(),
                                                     in_right.y() / in_right.z())};
    if (is_inside(match.left) && is_inside(match.right)) {
      matches.push_back(match);
    }
  }
  return matches;
}

/// Gives each position normal errors, and every `wrong_of_100` of a hundred matches a right
/// position anywhere.
inline void spoil(std::vector<PointMatch>& matches, int width, int height, double sigma_px,
                  int wrong_of_100, std::mt19937& random) {
  std::normal_distribution<double> error(0, sigma_px > 0 ? sigma_px : 1);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (sigma_px > 0) {
      matches[i].left += Eigen::Vector2d(error(random), error(random));
      matches[i].right += Eigen::Vector2d(error(random), error(random));
    }
    if (static_cast<int>(i * 37 % 100) < wrong_of_100) {
      matches[i].right = {uniform(random, 0, width - 1), uniform(random, 0, height - 1)};
    }
  }
}

}  // namespace test
}  // namespace vantage
