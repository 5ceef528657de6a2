#pragma once

#include "engine/image/photograph.h"
#include "engine/image/scene_mask.h"

namespace vantage::apps {

/// leave_out_of_pair() with the files of masks that the options name. Throws Error naming a file.
void leave_out_masked(const SceneMaskOptions& options, Photograph& left, Photograph& right);

}  // namespace vantage::apps
