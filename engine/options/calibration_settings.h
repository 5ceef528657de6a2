#pragma once

#include <optional>

#include "engine/options/settings.h"
#include "engine/rectification/kitti_cameras.h"
#include "engine/rectification/rectified_pair.h"

namespace vantage {

/// --kept-outline, in the present group.
void add_kept_outline_setting(Settings& settings, RectificationOptions& rectification);
/// --kitti-cameras, in the present group.
void add_kitti_cameras_setting(Settings& settings, std::optional<KittiCameras>& cameras);

}  // namespace vantage
