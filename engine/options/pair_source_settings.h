#pragma once

#include <optional>

#include "engine/options/settings.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// --left, --right, --offset, --stereo, --packing, --raw-video, --pairs, --sequence, --step and
/// --white-level, in the group that has begun.
void add_pair_source_settings(Settings& settings, PairSourceOptions& input);

/// --white-level, in the present group.
void add_white_level_setting(Settings& settings, std::optional<double>& white_level);

}  // namespace vantage
