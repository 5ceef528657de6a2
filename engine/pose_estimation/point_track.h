#pragma once

#include <Eigen/Core>
#include <vector>

namespace vantage {

/// Where one image shows a point.
struct PointSighting {
  int image = 0;
  /// From the principal point, in pixels; of a known lens without its distortion, and with fy = fx.
  Eigen::Vector2d position_px = {0, 0};
};

/// A point of the scene that several images show, each at most once.
struct PointTrack {
  std::vector<PointSighting> sightings;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< in the world, once it is known
};

}  // namespace vantage
