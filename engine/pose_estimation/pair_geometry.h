#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/rectification/feature_matches.h"

namespace vantage {

/// What the matches of two images tell about their cameras.
struct PairGeometry {
  int first = 0;
  int second = 0;
  /// x_second = rotation · x_first + length · direction.
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d direction = {1, 0, 0};  ///< of length 1
  int matches = 0;
  /// Features of both images that agree with it.
  std::vector<std::array<int, 2>> inliers = {};
};

/// Inliers that a pair must have at least.
inline constexpr int kMinPairInliers = 24;

/// The relative pose of two cameras of one focal length, by OpenCV's USAC with MAGSAC weights.
/// `matches`: positions from the principal point; `features`: their numbers. Empty if fewer than
/// kMinPairInliers or 30 % of the matches agree. Deterministic. Thread rule: may be called
/// concurrently.
std::optional<PairGeometry> pair_geometry(std::span<const PointMatch> matches,
                                          std::span<const std::array<int, 2>> features,
                                          double focal_px);

/// How far the epipolar geometry of matches is from that of two cameras of each focal length: the
/// relative difference of the two singular values of the essential matrix, 0 to 1. Empty if the
/// matches agree on no geometry.
std::vector<double> focal_disagreements(std::span<const PointMatch> matches,
                                        std::span<const double> focal_lengths_px);

}  // namespace vantage
