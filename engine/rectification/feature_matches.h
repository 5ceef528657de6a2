#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/image/photograph.h"

namespace vantage {

/// Where both photographs of a pair show the same point, in pixels, pixel centres at integers.
struct PointMatch {
  Eigen::Vector2d left = {0, 0};
  Eigen::Vector2d right = {0, 0};
};

enum class FeatureKind {
  kSift,  ///< finds partners despite other scales, angles and exposures; about 0.5 s for 640×480
  kOrb    ///< for images that are nearly rectified; a twentieth of the time
};

struct FeatureMatchOptions {
  FeatureKind kind = FeatureKind::kSift;
  /// Kept of each image, the strongest of every part of it. 100..20000.
  int most_features = 3000;
  /// Images with a longer side are reduced before the search; positions are of the full image.
  /// ≥ 64.
  int largest_side_px = 2000;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

/// Points that two photographs have in common, spread over the image: features (OpenCV's) whose
/// descriptors are each other's nearest, and clearly nearer than the second nearest. Partners are
/// then shifted to the sub-pixel position where the surroundings agree best (Lucas–Kanade on local
/// contrast, so exposure does not matter); those that find none stay out where `kind` is kOrb, and
/// stay where they are otherwise. A few per cent of the matches may be wrong. May be none, in
/// images without structure. The images may have different sizes.
///
/// The same result for any number of threads; may be called concurrently.
std::vector<PointMatch> match_features(const Photograph& left, const Photograph& right,
                                       const FeatureMatchOptions& options = {});

}  // namespace vantage
