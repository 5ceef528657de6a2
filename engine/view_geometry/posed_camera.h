#pragma once

#include <Eigen/Core>
#include <string>

namespace vantage {

/// A pinhole camera without distortion at any pose: a point X of the reference frame is seen at λ
/// (u, v, 1) = matrix · (rotation · X + translation), λ > 0. For new views the reference frame is
/// that of the rectified left camera, lengths in the unit of the pair's baseline.
struct PosedCamera {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();    ///< K: (fx, skew, cx), (0, fy, cy), …
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< R, camera ← reference frame, proper
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();   ///< t
  int width_px = 0;
  int height_px = 0;

  /// C = −Rᵀ t.
  [[nodiscard]] Eigen::Vector3d centre() const { return -rotation.transpose() * translation; }

  /// Throws Error naming `name` ("camera of the new view"), the quantity, its value and its limit:
  /// image size, focal lengths, singular or mirrored matrices, invalid rotations.
  void validate(const std::string& name) const;

  friend bool operator==(const PosedCamera&, const PosedCamera&) = default;
};

}  // namespace vantage
