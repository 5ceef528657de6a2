#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/rectification/feature_matches.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/rectifier.h"
#include "engine/rectification/stereo_calibration.h"
#include "engine/rectification/uncalibrated_rig.h"
#include "engine/rectification/vertical_error.h"

namespace vantage {

/// Reliability of estimated cameras away from the points that they were fitted to.
struct RigValidation {
  /// Row errors at held-out points: cameras are estimated from the points in every other tile of
  /// the left photograph and evaluated in the tiles between, and vice versa. None if half of the
  /// points are too few.
  std::optional<VerticalError> held_out;
  /// Share of the left photograph's tiles with at least one point that agrees with the cameras.
  double covered_share = 0;
};

/// Validates cameras that `rig` estimated from `matches` in photographs of this size. Takes about
/// as long as the estimate itself. Deterministic. Thread rule: may be called concurrently.
RigValidation validate_rig(const UncalibratedRig& rig, const std::vector<PointMatch>& matches,
                           int width_px, int height_px, const RectificationOptions& options);

/// Inputs and results of a rectification.
struct Rectification {
  StereoCalibration calibration;
  std::optional<UncalibratedRig> estimate;  ///< without a calibration file
  std::vector<PointMatch> matches = {};     ///< in the photographs, that the estimate is made from
  std::optional<VerticalError> remaining;
  std::optional<RigValidation> validation;  ///< of the estimate
};

/// Estimates again from points found in the images rectified by `rectifier`: there they are in
/// nearly the same rows, so that wrong matches are easy to detect and positions are exact. Kept if
/// rows correspond better. A baseline in metres is kept, if there is one. Thread rule: pure.
void improve_rectification(Rectification& rectification, Rectifier& rectifier,
                           const std::vector<PointMatch>& found,
                           const RectificationOptions& options);

/// Throws Error, whose text starts with `inputs`, if the estimate does not rectify the images.
/// `matches`: points found in the rectified images. Thread rule: pure.
void require_success(const Rectification& rectification, std::size_t matches,
                     const std::string& inputs);

}  // namespace vantage
