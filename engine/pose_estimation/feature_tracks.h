#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/pose_estimation/pair_geometry.h"

namespace vantage {

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
