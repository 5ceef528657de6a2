#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "perf/quality/sgbm_settings.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Tries sets of post-processing for settings of StereoSGBM and prints the best ones: those of the
/// least sum over `scenes` of the bad pixels (1 px), visible ones and all. `csv`: a file for the
/// figures of all sets, or empty. Throws Error when that cannot be written.
void search_sgbm_post_processing(const std::vector<SgbmSetting>& settings,
                                 const std::vector<const TrueScene*>& scenes,
                                 const std::filesystem::path& data, const std::string& csv,
                                 Execution& execution);

}  // namespace vantage::perf
