#pragma once

#include <optional>
#include <vector>

#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/uncalibrated_rig.h"
#include "engine/rectification/vertical_error.h"

namespace vantage {

/// How far estimated cameras can be trusted where no point was that they were fitted to.
struct RigValidation {
  /// Rows at points that were left out: cameras are estimated from the points in every other tile
  /// of the left photograph and rectify those in the tiles between, and the other way round. None
  /// where half of the points are too few.
  std::optional<VerticalError> held_out;
  /// Share of the left photograph's tiles that have a point which agrees with the cameras.
  double covered_share = 0;
};

/// Of cameras that `rig` estimates from `matches` in photographs of this size. Takes about as long
/// as the estimate itself. Thread rule: may be called concurrently; the same result every time.
RigValidation validate_rig(const UncalibratedRig& rig, const std::vector<PointMatch>& matches,
                           int width_px, int height_px, const RectificationOptions& options);

}  // namespace vantage
