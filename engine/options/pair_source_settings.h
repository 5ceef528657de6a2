#pragma once

#include "engine/options/settings.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage {

/// --left, --right, --offset, --stereo, --packing, --raw-video, --pairs, --sequence and --step, in
/// the group that has begun.
void add_pair_source_settings(Settings& settings, PairSourceOptions& input);

}  // namespace vantage
