#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "perf/quality/sgbm_settings.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// Searches sets of post-processing for settings of StereoSGBM and prints the best ones: those with
/// the smallest sum over `scenes` of bad pixels (1 px), visible and all. `csv`: output file for the
/// results of all sets, or empty. Throws Error if it cannot be written.
void search_sgbm_post_processing(const std::vector<SgbmSetting>& settings,
                                 const std::vector<const TrueScene*>& scenes,
                                 const std::filesystem::path& data, const std::string& csv,
                                 Execution& execution);

}  // namespace vantage::perf
