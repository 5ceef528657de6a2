#pragma once

#include <Eigen/Dense>
#include <Eigen/Geometry>

namespace vantage {

/// The rotation about `turn` by its length in radians. Thread rule: pure, as the next.
inline Eigen::Matrix3d rotation_by(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix()
                   : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

/// The inverse of rotation_by(): of length at most π.
inline Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

}  // namespace vantage
