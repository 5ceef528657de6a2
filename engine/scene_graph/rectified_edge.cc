#include "engine/scene_graph/rectified_edge.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "engine/error.h"
#include "engine/rectification/feature_matches.h"
#include "engine/rectification/relative_pose.h"
#include "engine/scene_graph/edge_check.h"

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
