#include "apps/inputs/automatic_disparities.h"

#include <fmt/format.h>

#include <cstdio>

#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "engine/matching/range_check.h"
#include "engine/matching/range_estimation.h"
#include "engine/matching/vertical_range.h"
#include "engine/options/match_settings.h"

namespace vantage::apps {
namespace {

void choose_vertical_disparities(const Settings& settings, const CommonOptions& common,
                                 const Photograph& left, const Photograph& right,
                                 MatchOptions& options, Execution& execution, RunReport& report) {
  if (!options.disparities_y_auto) {
    return;
  }
  const DisparityRange range = require_vertical_range(report.timed_compute(
      "range of rows", [&] { return find_vertical_range(left, right, execution); }));
  options.disparities_y = range;
  options.disparities_y_auto = false;
  options.validate();
  report.set_settings(reported_settings(settings, options));
  if (!common.quiet) {
    tell("{}: --disparities-y auto is {}\n", settings.command(), to_text(range));
  }
}

}  // namespace

void choose_disparities(const Settings& settings, const CommonOptions& common,
                        const std::function<std::optional<DisparityRange>()>& find,
                        MatchOptions& options, RunReport& report) {
  if (!options.disparities_auto) {
    return;
  }
  const DisparityRange range = require_disparity_range(report.timed_compute("range", find));
  options.disparities = range;
  options.disparities_auto = false;
  options.validate();
  report.set_settings(reported_settings(settings, options));
  if (!common.quiet) {
    tell("{}: --disparities auto is {}{}\n", settings.command(), to_text(range),
         -range.min > 2 * range.max ? ", mostly negative: the images look exchanged" : "");
  }
}

void choose_disparities(const Settings& settings, const CommonOptions& common,
                        const Photograph& left, const Photograph& right, MatchOptions& options,
                        Execution& execution, RunReport& report) {
  choose_vertical_disparities(settings, common, left, right, options, execution, report);
  choose_disparities(
      settings, common,
      [&] {
        return find_disparity_range(left, right, execution,
                                    options.disparities_y.value_or(DisparityRange{0, 0}));
      },
      options, report);
}

SettingValue cut_range_values(const CutRange& cut) {
  return {{"below", cut.below},
          {"above", cut.above},
          {"matches_at_min", cut.at_ends.at_min},
          {"matches_at_max", cut.at_ends.at_max},
          {"share_below", cut.share_below},
          {"share_above", cut.share_above}};
}

void warn_of_cut_range(const CommonOptions& common, const Photograph& left, const Photograph& right,
                       const DisparityMaps& maps, const MatchOptions& options, bool is_found,
                       Execution& execution, RunReport& report) {
  const MatchesAtEnds matches = matches_at_ends(maps, options);
  if (!may_be_cut(matches, options, is_found)) {
    return;
  }
  const CutRange cut = report.timed_compute(
      "range check", [&] { return look_beyond(matches, left, right, options, execution); });
  report.add_result("cut_range", cut_range_values(cut));
  if (cut.any()) {
    const Remark remark = cut_range_remark(cut, options.disparities, is_found);
    tell_remarks({&remark, 1}, common, report);
  }
}

}  // namespace vantage::apps
