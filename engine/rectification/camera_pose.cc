#include "engine/rectification/camera_pose.h"

#include <Eigen/Dense>
#include <cmath>

namespace vantage {

CameraPose relative_pose(const CameraPose& first, const CameraPose& second) {
  const Eigen::Matrix3d rotation = second.rotation * first.rotation.transpose();
  return {.rotation = rotation, .translation = second.translation - rotation * first.translation};
}

std::optional<Eigen::Matrix3d> rotation_of_quaternion(const std::array<double, 4>& wxyz) {
  constexpr double kNormTolerance = 0.01;
  const Eigen::Quaterniond quaternion(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  if (!(std::abs(quaternion.norm() - 1) <= kNormTolerance)) {
    return std::nullopt;
  }
  return quaternion.normalized().toRotationMatrix();
}

std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& matrix) {
  constexpr double kTolerance = 1e-3;
  if (!matrix.allFinite()) {
    return std::nullopt;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  if (rotation.determinant() < 0 || (rotation - matrix).cwiseAbs().maxCoeff() > kTolerance) {
    return std::nullopt;
  }
  return rotation;
}

}  // namespace vantage
