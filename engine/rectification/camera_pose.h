#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace vantage {

/// Orientation and position of a camera in a world frame: x_camera = rotation · x_world +
/// translation, with X right, Y down and Z forward in the camera's frame.
struct CameraPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< in the unit of the world

  /// −Rᵀ t, in the world.
  [[nodiscard]] Eigen::Vector3d centre() const { return -rotation.transpose() * translation; }

  /// From the inverse: x_world = rotation · x_camera + centre.
  static CameraPose from_camera_to_world(const Eigen::Matrix3d& rotation,
                                         const Eigen::Vector3d& centre) {
    return {.rotation = rotation.transpose(), .translation = -rotation.transpose() * centre};
  }

  friend bool operator==(const CameraPose&, const CameraPose&) = default;
};

/// The pose of `second` in the frame of `first`: x_second = rotation · x_first + translation.
CameraPose relative_pose(const CameraPose& first, const CameraPose& second);

/// The rotation of a Hamilton quaternion, w first, normalised. None if its norm is more than 1 %
/// off 1, as that of numbers in another order or of another meaning.
std::optional<Eigen::Matrix3d> rotation_of_quaternion(const std::array<double, 4>& wxyz);

/// The rotation nearest to a matrix written with few digits. None if an element differs by more
/// than 0.001, or it is mirrored.
std::optional<Eigen::Matrix3d> nearest_rotation(const Eigen::Matrix3d& matrix);

}  // namespace vantage
