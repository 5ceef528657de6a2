#pragma once

#include <vector>

#include "engine/rectification/feature_matches.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// A rig as its images alone tell of it.
struct UncalibratedRig {
  /// The likeliest cameras. What a single pair does not tell (above all the focal length) is as
  /// usual, so depths are of no use; its rectified_pair() is as good as one of known cameras: rows
  /// correspond and the images are stretched least. The baseline has length 1.
  StereoCalibration calibration = {};
  std::vector<bool> is_inlier = {};  ///< per match: agrees with the cameras
  int inliers = 0;
  /// Of the inliers' distances from their epipolar lines, in pixels of the photographs.
  double rms_px = 0;
};

/// The cameras that photographed these matches: of one pair, or of many pairs of one rig together.
/// A fundamental matrix is found among wrong matches (OpenCV's USAC with MAGSAC weights, the same
/// samples every time), then the cameras are fitted to the matches near it (see RigModel) and
/// those chosen anew, until nothing changes. Images of unequal exposure, zoom or lens are fine as
/// long as their sizes are equal; lens distortion is found where it matters. Up to half of the
/// matches may be wrong. The left camera is the one whose images are the left ones, whatever the
/// disparities say.
///
/// Throws Error, naming quantity and limit: fewer than 20 matches, or agreeing
/// ones, or fewer than 30 % that agree; a camera that
/// only turned (nothing moves against anything else); one that moved forward or backward (the
/// epipole is inside the image). Thread rule: may be called concurrently; the same result every
/// time. About a second for 3000 matches; of more than 3000 it takes every second, third ….
UncalibratedRig estimate_rig(const std::vector<PointMatch>& matches, int width_px, int height_px);

}  // namespace vantage
