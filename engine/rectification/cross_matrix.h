#pragma once

#include <Eigen/Core>

namespace vantage {

/// The matrix whose product with a vector is the cross product of `v` and that vector. Thread rule:
/// pure.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

}  // namespace vantage
