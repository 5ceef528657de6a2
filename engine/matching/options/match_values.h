#pragma once

#include "engine/combinations/option_values.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

/// The values in force by option, for rules that concern several.
OptionValues values_of(const MatchOptions& options);

}  // namespace vantage
