#pragma once

#include <functional>
#include <string_view>

#include "apps/option_groups.h"
#include "apps/run_report.h"
#include "apps/settings.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"

namespace vantage::apps {

/// --no-rectification-check; `wanted` is true without it.
void add_rectification_check_setting(Settings& settings, bool& wanted);

/// Whether whoever chose the range of disparities knows that most are negative. To be asked before
/// choose_disparities(): what is found is nobody's choice.
bool expects_negative_disparities(const MatchOptions& options);

/// Looks whether the rows of a pair that ought to be rectified correspond. The report gets the
/// numbers as `results.rectification`; where rows are off (the systematic part of the error, RMS)
/// so far that it costs more than kMostMoreBad_percent of the pixels, a warning on stderr says by
/// how much. Another one says when nearly all disparities are negative, unless `expects_negative`.
/// Results and exit codes do not depend on it. Its time is a stage of its own ("check"), not
/// compute time. Says nothing about pairs with too few points in common to tell.
void warn_unless_rectified(const Settings& settings, const CommonOptions& common,
                           bool expects_negative, const Photograph& left, const Photograph& right,
                           RunReport& report);
/// The same while `work` is done with the same pair, as looking keeps but one thread busy. What
/// there is to say is said when both are done; `work` may throw. `lines`: "rows", or "columns" of a
/// transposed pair.
void warn_unless_rectified_beside(const std::function<void()>& work, const Settings& settings,
                                  const CommonOptions& common, bool expects_negative,
                                  std::string_view lines, const Photograph& left,
                                  const Photograph& right, Execution& execution, RunReport& report);

}  // namespace vantage::apps
