#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"
#include "engine/rectification/stereo_calibration.h"
#include "engine/rectification/vertical_error.h"
#include "engine/scene_graph/posed_pair.h"
#include "engine/scene_graph/scene_layout.h"

namespace vantage {

/// Limits beyond which an edge of a scene is useless. Rectified photographs have row errors up to
/// 0.4 px, and at least 62 % of their pixels match. A camera turned by a degree makes errors above
/// 2 px, where as few as 26 % match; of unrelated images 10 to 19 %.
inline constexpr double kMaxEdgeError_px = 1.5;
inline constexpr double kMinEdgeMatchedShare = 0.3;

/// What corresponds in the two images of an edge: "rows", "columns" or "lines along the edge".
std::string_view lines_of(const SceneEdge& edge);

/// Row error of two images whose rows should correspond, measured again in full-size images where
/// it looks larger than `limit_px`; none if there are too few points. Thread rule: may be called
/// concurrently.
std::optional<VerticalError> edge_error(const Photograph& first, const Photograph& second,
                                        double limit_px);

/// Row error of the two images of an edge, transposed and sheared so that `lines` are rows; none if
/// there are too few points. Throws Error if the images are not a rectified pair:
/// VerticalError::systematic_px above kMaxEdgeError_px. Thread rule: may be called concurrently.
std::optional<VerticalError> require_rectified(const Photograph& first, const Photograph& second,
                                               std::string_view lines);

/// Matched share that an edge between posed cameras needs without points in common to check it by:
/// in a range of a few disparities many pixels of unrelated images match.
inline constexpr double kMinUncheckedMatchedShare = 0.6;
/// Share of points with negative disparities, that is beyond infinity, above which poses are wrong.
inline constexpr double kMaxNegativeShare = 0.5;

/// Throws Error if the images of posed cameras have too few points in common for `rectification`,
/// and less than kMinUncheckedMatchedShare of one of them matches.
void require_checked_or_matched(const std::array<double, 2>& matched_share,
                                const std::optional<VerticalError>& rectification);

/// Throws Error if less than kMinEdgeMatchedShare of one of the images matches. The message says
/// what was `searched`, and if the points of `rectification` show that the images are exchanged.
void require_matched(const std::array<double, 2>& matched_share, const DisparityRange& searched,
                     const std::optional<VerticalError>& rectification);

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
