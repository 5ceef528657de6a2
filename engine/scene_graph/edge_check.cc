#include "engine/scene_graph/edge_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "engine/error.h"
#include "engine/rectification/feature_matches.h"

namespace vantage {

std::string_view lines_of(const SceneEdge& edge) {
  if (edge.slope != 0) {
    return "lines along the edge";
  }
  return edge.is_vertical ? "columns" : "rows";
}

std::optional<VerticalError> edge_error(const Photograph& first, const Photograph& second,
                                        double limit_px) {
  std::optional<VerticalError> error = check_rectification(first, second);
  if (error && error->systematic_px > limit_px) {
    // The check looks at reduced images, where a pixel of a large image is little.
    const auto sure = vertical_error(match_features(first, second));
    error = sure ? sure : error;
  }
  return error;
}

std::optional<VerticalError> require_rectified(const Photograph& first, const Photograph& second,
                                               std::string_view lines) {
  const std::optional<VerticalError> error = edge_error(first, second, kMaxEdgeError_px);
  if (error && error->systematic_px > kMaxEdgeError_px) {
    throw Error(fmt::format(
        "not a rectified pair: {} are off by {:.2f} px ({} points), expected at most {} px; find "
        "the poses of hand-held cameras with 'vantage scene poses', align two images with 'vantage "
        "rectify', correct their positions, or accept them with `no-rectification-check`",
        lines, error->systematic_px, error->inliers, kMaxEdgeError_px));
  }
  return error;
}

void require_matched(const std::array<double, 2>& matched_share, const DisparityRange& searched,
                     const std::optional<VerticalError>& rectification) {
  const double share = *std::min_element(matched_share.begin(), matched_share.end());
  if (share >= kMinEdgeMatchedShare) {
    return;
  }
  const std::string reason =
      rectification && rectification->looks_exchanged()
          ? fmt::format(
                "the images look exchanged ({:.0f} % of {} points have negative "
                "disparities), correct their positions",
                100 * rectification->negative_share, rectification->inliers)
          : fmt::format("check images, positions and `disparities` ({}:{} was searched)",
                        searched.min, searched.max);
  throw Error(fmt::format(
      "{:.0f} % of the pixels match, expected at least {:.0f} %; {}, or accept them with "
      "`no-rectification-check`",
      100 * share, 100 * kMinEdgeMatchedShare, reason));
}

void require_checked_or_matched(const std::array<double, 2>& matched_share,
                                const std::optional<VerticalError>& rectification) {
  const double share = *std::min_element(matched_share.begin(), matched_share.end());
  if (!rectification && share < kMinUncheckedMatchedShare) {
    throw Error(fmt::format(
        "too few points in common, and {:.0f} % of the pixels match, expected at least {:.0f} %",
        100 * share, 100 * kMinUncheckedMatchedShare));
  }
}

}  // namespace vantage
