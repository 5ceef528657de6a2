#pragma once

#include <functional>
#include <optional>

#include "apps/option_groups.h"
#include "apps/run_report.h"
#include "apps/settings.h"
#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"

namespace vantage::apps {

/// Where --disparities is auto: replaces it by what `find` says, in `options` and in the settings
/// of the report, as a stage of compute time, and tells it on stderr. Throws Error when `find` says
/// nothing, and UsageError when the range does not go with other options.
void choose_disparities(const Settings& settings, const CommonOptions& common,
                        const std::function<std::optional<DisparityRange>()>& find,
                        MatchOptions& options, RunReport& report);
/// Estimates the range from the pair, and the range of --disparities-y if it is auto.
void choose_disparities(const Settings& settings, const CommonOptions& common,
                        const Photograph& left, const Photograph& right, MatchOptions& options,
                        Execution& execution, RunReport& report);

}  // namespace vantage::apps
