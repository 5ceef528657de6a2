#include "engine/rectification/feature_matches.h"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "engine/error.h"
#include "engine/rectification/image_features.h"

namespace vantage {

void FeatureMatchOptions::validate() const {
  if (max_features < 100 || max_features > 20000) {
    throw UsageError(
        fmt::format("most-features is {}, expected a number from 100 to 20000", max_features));
  }
  if (largest_side_px < 64) {
    throw UsageError(fmt::format("largest-side is {}, expected at least 64", largest_side_px));
  }
}

std::vector<PointMatch> match_features(const Photograph& left, const Photograph& right,
                                       const FeatureMatchOptions& options) {
  const ImageFeatures left_features(left, options);
  const ImageFeatures right_features(right, options);
  const std::vector<std::array<int, 2>> pairs = mutual_features(left_features, right_features);
  const std::vector<std::optional<Eigen::Vector2d>> partners =
      refined_partners(left_features, right_features, pairs);
  std::vector<PointMatch> matches;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!partners[i] && options.kind == FeatureKind::kOrb) {
      continue;
    }
    matches.push_back(
        {.left = left_features.position_px(pairs[i][0]),
         .right = partners[i] ? *partners[i] : right_features.position_px(pairs[i][1])});
  }
  return matches;
}

}  // namespace vantage
