#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "engine/pose_estimation/pair_geometry.h"

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

/// A feature of an image.
struct FeatureOfImage {
  int image = 0;
  int feature = 0;
  friend auto operator<=>(const FeatureOfImage&, const FeatureOfImage&) = default;
};

/// Joins the inliers of pairs to points that several images show. Points that an image would show
/// twice are left out. Each with its features by image, in the order of the first ones. Thread
/// rule: pure.
std::vector<std::vector<FeatureOfImage>> feature_tracks(std::span<const PairGeometry> pairs);

}  // namespace vantage
