#pragma once

#include <string>

#include "engine/options/setting_value.h"
#include "engine/rectification/improved_rectification.h"
#include "engine/rectification/rectified_pair.h"

namespace vantage::apps {

/// The entry `results` of the report of 'rectify'.
SettingValue results_of(const Rectification& rectification, const RectifiedPair& pair,
                        int pair_count);

/// Prints the results to stderr. `calibration` is the path to the file; empty: none.
void print_results(const Rectification& rectification, const RectifiedPair& pair, int pair_count,
                   const std::string& calibration);

}  // namespace vantage::apps
