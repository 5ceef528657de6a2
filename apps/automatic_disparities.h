#pragma once

#include "apps/option_groups.h"
#include "apps/run_report.h"
#include "apps/settings.h"
#include "engine/execution.h"
#include "engine/image/photograph.h"

namespace vantage::apps {

/// Where --disparities is auto: replaces it by the range that the pair suggests, in `options` and
/// in the settings of the report, as a stage of compute time, and tells it on stderr. Throws as
/// estimate_disparity_range() does, and UsageError when the range does not go with other options.
void choose_disparities(const Settings& settings, const CommonOptions& common,
                        const Photograph& left, const Photograph& right, MatchOptions& options,
                        Execution& execution, RunReport& report);

}  // namespace vantage::apps
