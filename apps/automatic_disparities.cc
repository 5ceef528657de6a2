#include "apps/automatic_disparities.h"

#include <fmt/format.h>

#include <cstdio>

#include "apps/match_settings.h"
#include "apps/tell.h"
#include "engine/error.h"
#include "engine/matching/range_estimation.h"
#include "engine/matching/vertical_range.h"

namespace vantage::apps {
namespace {

void choose_vertical_disparities(const Settings& settings, const CommonOptions& common,
                                 const Photograph& left, const Photograph& right,
                                 MatchOptions& options, Execution& execution, RunReport& report) {
  if (!options.disparities_y_auto) {
    return;
  }
  const std::optional<DisparityRange> range = report.timed_compute(
      "range of rows", [&] { return find_vertical_range(left, right, execution); });
  if (!range) {
    throw Error(
        "the images have too few points in common to estimate the vertical range, expected texture "
        "that both show; give --disparities-y MIN:MAX");
  }
  options.disparities_y = *range;
  options.disparities_y_auto = false;
  options.validate();
  report.set_settings(reported_settings(settings, options));
  if (!common.quiet) {
    tell("{}: --disparities-y auto is {}\n", settings.command(), to_text(*range));
  }
}

}  // namespace

void choose_disparities(const Settings& settings, const CommonOptions& common,
                        const std::function<std::optional<DisparityRange>()>& find,
                        MatchOptions& options, RunReport& report) {
  if (!options.disparities_auto) {
    return;
  }
  const std::optional<DisparityRange> range = report.timed_compute("range", find);
  if (!range) {
    throw Error(
        "no disparity range can be estimated from the images, expected texture that both show; "
        "give --disparities MIN:MAX");
  }
  options.disparities = *range;
  options.disparities_auto = false;
  options.validate();
  report.set_settings(reported_settings(settings, options));
  if (!common.quiet) {
    tell("{}: --disparities auto is {}{}\n", settings.command(), to_text(*range),
         -range->min > 2 * range->max ? ", mostly negative: left and right look exchanged" : "");
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

}  // namespace vantage::apps
