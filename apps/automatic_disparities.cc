#include "apps/automatic_disparities.h"

#include <fmt/format.h>

#include <cstdio>

#include "apps/tell.h"
#include "engine/matching/disparity_range.h"

namespace vantage::apps {

void choose_disparities(const Settings& settings, const CommonOptions& common,
                        const Photograph& left, const Photograph& right, MatchOptions& options,
                        Execution& execution, RunReport& report) {
  if (!options.disparities_auto) {
    return;
  }
  options.disparities = report.timed_compute(
      "range", [&] { return estimate_disparity_range(left, right, execution); });
  options.disparities_auto = false;
  options.validate();
  report.set_settings(reported_settings(settings, options));
  if (!common.quiet) {
    tell("{}: --disparities auto is {}:{}\n", settings.command(), options.disparities.min,
         options.disparities.max);
  }
}

}  // namespace vantage::apps
