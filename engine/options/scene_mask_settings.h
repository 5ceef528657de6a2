#pragma once

#include "engine/io/images/scene_mask.h"
#include "engine/options/settings.h"

namespace vantage {

/// --mask, --mask-right and --no-data, in the group that has begun. `per_frame`: of a sequence.
void add_scene_mask_settings(Settings& settings, SceneMaskOptions& masks, bool per_frame = false);

}  // namespace vantage
