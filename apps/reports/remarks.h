#pragma once

#include <span>

#include "apps/reports/run_report.h"
#include "apps/settings/common_options.h"
#include "engine/remark.h"

namespace vantage::apps {

/// Prints remarks of the engine on stderr, unless that is quiet, and adds them to the report.
void tell_remarks(std::span<const Remark> remarks, const CommonOptions& common, RunReport& report);
/// Prints thread_remarks() of the execution like tell_remarks(), and adds them to the report.
void tell_threads(const Execution& execution, const CommonOptions& common, RunReport& report);
/// The same for those of a match, and what its map is worth (`results.map`); adds its stages.
void tell_match(const MatchReport& match, const CommonOptions& common, RunReport& report);
/// One line: how much of the map was matched and filled. Unless that is quiet.
void tell_shares(const MatchReport& match, const CommonOptions& common, const RunReport& report);
/// What a map is worth, as values of a report.
SettingValue map_values(const MapShares& shares);
/// Noise that was found, likewise; null where there is none.
SettingValue noise_values(const FoundNoise& noise);

}  // namespace vantage::apps
