#include "engine/scene_graph/rectified_edge.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "engine/error.h"
#include "engine/rectification/feature_matches.h"
#include "engine/rectification/relative_pose.h"
#include "engine/rectification/rows/row_check.h"

namespace vantage {
namespace {

RectifiedEdge rectified_by(const StereoCalibration& calibration,
                           const std::array<Photograph, 2>& photographs, Execution& execution) {
  PosedPair pair(calibration, photographs[0].width(), photographs[0].height(), execution);
  std::array<Photograph, 2> images = pair.rectified(photographs);
  return {.pair = std::move(pair),
          .images = std::move(images),
          .error = std::nullopt,
          .corrected_degrees = std::nullopt};
}

/// Empty if the images do not tell a pose; `why_not` is then set.
std::optional<RectifiedEdge> corrected(const StereoCalibration& calibration,
                                       const std::array<Photograph, 2>& photographs,
                                       Execution& execution, std::string& why_not) {
  try {
    const RefinedPose refined =
        refine_relative_pose(calibration, match_features(photographs[0], photographs[1]));
    RectifiedEdge edge = rectified_by(refined.calibration, photographs, execution);
    edge.error = edge_error(edge.images[0], edge.images[1], kCorrectedAbove_px);
    edge.corrected_degrees = refined.turned_degrees;
    return edge;
  } catch (const Error& error) {
    why_not = error.what();
    return std::nullopt;
  }
}

void require_in_front(const std::optional<VerticalError>& error) {
  if (error && error->negative_share > kMaxNegativeShare) {
    throw Error(fmt::format(
        "{:.0f} % of {} points in common would be beyond infinity, expected at most {:.0f} %: the "
        "poses are wrong",
        100 * error->negative_share, error->inliers, 100 * kMaxNegativeShare));
  }
}

}  // namespace

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
    // Features are of reduced images, where a pixel of a large image is little.
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

RectifiedEdge rectify_edge(const StereoCalibration& calibration,
                           const std::array<Photograph, 2>& photographs, bool check,
                           Execution& execution) {
  RectifiedEdge edge = rectified_by(calibration, photographs, execution);
  if (!check) {
    return edge;
  }
  edge.error = edge_error(edge.images[0], edge.images[1], kCorrectedAbove_px);
  if (!edge.error || edge.error->systematic_px <= kCorrectedAbove_px) {
    require_in_front(edge.error);
    return edge;
  }
  std::string why_not = "corrected poses do not fit better";
  std::optional<RectifiedEdge> better = corrected(calibration, photographs, execution, why_not);
  if (better && better->error && better->error->systematic_px < edge.error->systematic_px) {
    edge = std::move(*better);
  }
  if (edge.error->systematic_px > kMaxEdgeError_px) {
    throw Error(fmt::format("rows are off by {:.2f} px ({} points), expected at most {} px; {}",
                            edge.error->systematic_px, edge.error->inliers, kMaxEdgeError_px,
                            edge.corrected_degrees ? "that with a corrected pose" : why_not));
  }
  require_in_front(edge.error);
  return edge;
}

}  // namespace vantage
