#pragma once

#include "engine/execution.h"
#include "engine/matching/volume/volume_writer.h"
#include "engine/matching/windows/coarse_beliefs.h"

namespace vantage {

/// Hands the result of a level of windows to a writer: of each pixel the window that holds its
/// winner. count: candidates of the level.
void write_window_volume(const WindowState& state, int count, const VolumeWriter& writer,
                         Execution& execution);

}  // namespace vantage
