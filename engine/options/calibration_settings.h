#pragma once

#include <optional>

#include "engine/options/settings.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// --kept-outline, in the present group.
void add_kept_outline_setting(Settings& settings, RectificationOptions& rectification);
/// --kitti-cameras and --lens, in the present group.
void add_calibration_choice_settings(Settings& settings, CalibrationChoice& choice);
/// --lens.
void add_lens_setting(Settings& settings, std::optional<LensKind>& lens);

}  // namespace vantage
