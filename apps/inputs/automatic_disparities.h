#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "apps/reports/run_report.h"
#include "apps/settings/common_options.h"
#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/range_check.h"
#include "engine/options/settings.h"

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

/// Checks whether matches pile up at the ends of the range. Warns on stderr of disparities that
/// seem to be left out (look_beyond()) and reports `results.cut_range`. Results and exit codes do
/// not depend on it. `is_found`: choose_disparities() estimated the range, so it may end at 0,
/// which is infinity.
void warn_of_cut_range(const CommonOptions& common, const Photograph& left, const Photograph& right,
                       const DisparityMaps& maps, const MatchOptions& options, bool is_found,
                       Execution& execution, RunReport& report);
/// The check as values of a report.
SettingValue cut_range_values(const CutRange& cut);

}  // namespace vantage::apps
