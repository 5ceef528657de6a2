#pragma once

#include <optional>
#include <string>
#include <utility>

#include "engine/options/settings.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// "10", "10+5" (every tenth frame from frame 5 on) or "4s": a value of --every.
std::string to_text(const FrameStep& every);

/// Two whole numbers from 0 on with a separator between them.
std::optional<std::pair<int, int>> two_numbers(const std::string& text, char separator);

/// Binds `every` to the setting --every.
void add_frame_step_setting(Settings& settings, FrameStep& every);

/// Binds --frames: all (empty), or A-B, and :N after it (empty: without).
void add_frames_setting(Settings& settings, std::optional<FrameRange>& frames,
                        std::optional<int>& step);

}  // namespace vantage
