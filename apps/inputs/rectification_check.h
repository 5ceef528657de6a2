#pragma once

#include <functional>
#include <string_view>

#include "apps/reports/run_report.h"
#include "apps/settings/common_options.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// --no-rectification-check, with its help text; `wanted` is true without it.
void add_rectification_check_setting(
    Settings& settings, bool& wanted,
    const char* text =
        "Do not check, and warn, whether rows correspond and whether left and right are exchanged");

/// Whether the user chose a range whose disparities are mostly negative. Call it before
/// choose_disparities(), which replaces an automatic range.
bool expects_negative_disparities(const MatchOptions& options);

/// Checks whether the rows of a pair correspond, as those of a rectified pair do. Adds the numbers
/// to the report as `results.rectification`. Warns on stderr if the systematic row error (RMS)
/// makes more than kMaxMoreBad_percent of the pixels wrong, and, unless `expects_negative`, if
/// nearly all disparities are negative. Results and exit codes do not depend on it. Its time is the
/// stage "check", not compute time. No warning if the images have too few points in common.
void warn_unless_rectified(const Settings& settings, const CommonOptions& common,
                           bool expects_negative, const Photograph& left, const Photograph& right,
                           RunReport& report);
/// As warn_unless_rectified(), but runs concurrently with `work` on the same pair, because the
/// check uses one thread only. Warns after both have ended; `work` may throw. `lines`: "rows", or
/// "columns" for a transposed pair.
void warn_unless_rectified_beside(const std::function<void()>& work, const Settings& settings,
                                  const CommonOptions& common, bool expects_negative,
                                  std::string_view lines, const Photograph& left,
                                  const Photograph& right, Execution& execution, RunReport& report);

}  // namespace vantage::apps
