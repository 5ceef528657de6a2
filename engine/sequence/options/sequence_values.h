#pragma once

#include "engine/combinations/option_values.h"
#include "engine/sequence/options/sequence_options.h"

namespace vantage {

/// The values in force by option, for rules that concern several.
OptionValues values_of(const SequenceOptions& options);

}  // namespace vantage
