#pragma once

#include <array>
#include <optional>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/rectification/stereo_calibration.h"
#include "engine/rectification/vertical_error.h"
#include "engine/scene_graph/posed_pair.h"

namespace vantage {

/// Row error above which the pose between two cameras is corrected: rows of rectified photographs
/// are off by up to 0.4 px.
inline constexpr double kCorrectedAbove_px = 0.4;

/// An edge between posed cameras, rectified.
struct RectifiedEdge {
  PosedPair pair;
  std::array<Photograph, 2> images;    ///< rows correspond
  std::optional<VerticalError> error;  ///< of `images`; none if unchecked, or too few points
  /// Angle by which the pose was turned to make rows correspond; none if used as given.
  std::optional<double> corrected_degrees;
};

/// Rectifies photographs of two posed cameras. If `check`, and rows are off by more than
/// kCorrectedAbove_px, the pose is corrected from points in common, and used if rows then fit
/// better. Throws Error if they are off by more than kMaxEdgeError_px all the same, if more than
/// kMaxNegativeShare of the points would be beyond infinity, and as rectified_pair() does.
RectifiedEdge rectify_edge(const StereoCalibration& calibration,
                           const std::array<Photograph, 2>& photographs, bool check,
                           Execution& execution);

}  // namespace vantage
