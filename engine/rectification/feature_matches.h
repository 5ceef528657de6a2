#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/image/photograph.h"

namespace vantage {

/// Positions of one point in both photographs of a pair, in pixels, pixel centres at integers.
struct PointMatch {
  Eigen::Vector2d left = {0, 0};
  Eigen::Vector2d right = {0, 0};
};

enum class FeatureKind {
  kSift,  ///< invariant to scale, rotation and exposure; about 0.5 s for 640×480
  kOrb    ///< for nearly rectified images; a twentieth of the time
};

struct FeatureMatchOptions {
  FeatureKind kind = FeatureKind::kSift;
  /// Features kept per image: the strongest of every part of it. 100..20000.
  int max_features = 3000;
  /// Images with a longer side are reduced before detection; positions are of the full image. ≥ 64.
  int largest_side_px = 2000;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

/// Matches points of two photographs, spread over the image: OpenCV features whose descriptors are
/// mutually nearest, and clearly nearer than the second nearest. Partners are then refined to the
/// sub-pixel position of the best local agreement (Lucas–Kanade on local contrast, so exposure does
/// not matter); if this fails, kOrb drops the match and kSift keeps the position. A few per cent of
/// the matches may be wrong. May be empty for images without structure. The images may have
/// different sizes.
///
/// Deterministic for any number of threads; may be called concurrently.
std::vector<PointMatch> match_features(const Photograph& left, const Photograph& right,
                                       const FeatureMatchOptions& options = {});

}  // namespace vantage
