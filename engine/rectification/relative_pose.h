#pragma once

#include <vector>

#include "engine/rectification/feature_matches.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// The relative pose of two known lenses, refined.
struct RefinedPose {
  StereoCalibration calibration;  ///< rotation and direction of the translation changed
  int inliers = 0;
  double rms_px = 0;          ///< distance of inliers from their epipolar lines
  double turned_degrees = 0;  ///< of the rotation, from the given one
  double moved_degrees = 0;   ///< of the direction of the translation
};

/// Refines the relative pose of `calibration` from matches between its photographs, as far as rows
/// tell it: the direction of the baseline, and the turn about it and about the viewing direction.
/// Its length is kept, and so is the turn about the third axis, which moves all disparities alike
/// and hardly any row. Matches that agree with one pose are found among wrong ones (OpenCV's USAC
/// with MAGSAC weights), then the pose is fitted to them (least squares of Sampson distances, with
/// weights that fall to 0 for outliers). Deterministic. Thread rule: may be called concurrently.
///
/// Throws Error, naming quantity and limit: fewer than 20 inliers, fewer than 30 % of the matches,
/// or a pose more than 10 degrees (translation: 30) from the given one, which is then another
/// one's.
RefinedPose refine_relative_pose(const StereoCalibration& calibration,
                                 const std::vector<PointMatch>& matches);

}  // namespace vantage
