#pragma once

#include <string>

#include "apps/settings.h"
#include "engine/sequence/pair_source.h"

namespace vantage::apps {

/// "10", "10+5" (every tenth frame from frame 5 on) or "4s": a value of --every.
std::string to_text(const FrameStep& every);

/// Binds `every` to the setting --every.
void add_frame_step_setting(Settings& settings, FrameStep& every);

}  // namespace vantage::apps
