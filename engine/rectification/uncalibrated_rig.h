#pragma once

#include <vector>

#include "engine/rectification/feature_matches.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// A rig estimated from its images alone.
struct UncalibratedRig {
  /// The most likely cameras. What a single pair does not determine (above all the focal length)
  /// has its usual value, so depths are meaningless; its rectified_pair() is as good as one of
  /// known cameras: rows correspond with minimal stretching. The baseline has length 1.
  StereoCalibration calibration = {};
  std::vector<bool> is_inlier = {};  ///< per match: agrees with the cameras
  int inliers = 0;
  /// RMS distance of inliers from their epipolar lines, in pixels of the photographs.
  double rms_px = 0;
};

/// Estimates the cameras from matches of one pair, or of many pairs of one rig together. A
/// fundamental matrix is found among wrong matches (OpenCV's USAC with MAGSAC weights,
/// deterministic samples), then the cameras are fitted to the matches near it (see RigModel) and
/// the inliers are reselected until convergence. Images may differ in exposure, zoom and lens as
/// long as their sizes are equal; lens distortion is estimated where it matters. Up to half of the
/// matches may be wrong. The left camera is that of the left images, whatever the sign of the
/// disparities.
///
/// Throws Error, naming quantity and limit: fewer than 20 matches, or inliers, or fewer than 30 %
/// inliers; a pure rotation (no parallax); a forward or backward motion (the epipole is inside the
/// image). Deterministic. Thread rule: may be called concurrently. About a second for 3000 matches;
/// of more than 3000 it uses every second, third ….
UncalibratedRig estimate_rig(const std::vector<PointMatch>& matches, int width_px, int height_px);

}  // namespace vantage
