#pragma once

#include <optional>
#include <vector>

#include "engine/rectification/rectified_pair.h"
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

}  // namespace vantage
