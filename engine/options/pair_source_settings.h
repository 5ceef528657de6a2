#pragma once

#include <optional>

#include "engine/options/settings.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// --left, --right, --offset, --pair-by, --stereo, --packing, --deinterlace, --raw-video,
/// --pairs, --sequence, --step, --white-level and --orientation, in the group that has begun.
void add_pair_source_settings(Settings& settings, PairSourceOptions& input);

/// --pair-by, in the present group.
void add_pair_by_setting(Settings& settings, std::optional<PairBy>& pair_by);

/// --deinterlace, in the present group.
void add_deinterlace_setting(Settings& settings, PhotographReading& reading);

/// --orientation, in the present group.
void add_reading_settings(Settings& settings, PhotographReading& reading);

/// --white-level, in the present group.
void add_white_level_setting(Settings& settings, std::optional<double>& white_level);

}  // namespace vantage
