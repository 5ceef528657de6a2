#pragma once

#include <Eigen/Dense>
#include <cmath>

namespace vantage {

/// Angle between two directions of any length, in radians; 0 if one has none. Thread rule: pure.
inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace vantage
