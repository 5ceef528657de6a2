#include "apps/match/asp_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "apps/commands/commands.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/reports/run_report.h"
#include "engine/error.h"
#include "engine/image/no_data.h"
#include "engine/io/maps/map_formats.h"
#include "engine/io/maps/map_io.h"
#include "engine/matching/options/method_names.h"
#include "engine/matching/range_estimation.h"
#include "engine/matching/stereo_matcher.h"

namespace vantage::apps {
namespace {

void check(const AspJob& job, const Settings& settings) {
  job.common.execution.validate();
  if (job.min_px.has_value() != job.max_px.has_value()) {
    throw UsageError(fmt::format("--{} is set alone, expected both --disp-min and --disp-max",
                                 job.min_px ? "disp-min" : "disp-max"));
  }
  constexpr int kMaxDisparity_px = 65535;  // as MatchOptions has it, with the other sign
  if (job.min_px && (*job.min_px < -kMaxDisparity_px || *job.max_px > kMaxDisparity_px)) {
    throw UsageError(fmt::format("--disp-min is {} and --disp-max {}, expected numbers within ±{}",
                                 *job.min_px, *job.max_px, kMaxDisparity_px));
  }
  if (job.min_px && *job.min_px > *job.max_px) {
    throw UsageError(fmt::format("--disp-min is {} and --disp-max {}, expected the smaller first",
                                 *job.min_px, *job.max_px));
  }
  if (has_extension(job.output, {".png"})) {
    throw UsageError(
        fmt::format("DISPARITY is '{}', but PNG holds no gaps and no negative numbers, "
                    "expected {}",
                    job.output, listed_map_formats(MapContent::kConfidence)));
  }
  FileChecks files(settings);
  files.add_output(job.output, "DISPARITY", OutputKind::kDisparity);
  check_common_files(job.common, files);
}

/// Range of disparities of both signs. Empty if no points of the images match.
std::optional<DisparityRange> found_range(const Photograph& left, const Photograph& right,
                                          Execution& execution) {
  // Each search covers more on one side of 0.
  std::optional<DisparityRange> range =
      find_disparity_range(left, right, execution, {0, 0}, Infinity::kAnywhere);
  if (const auto exchanged =
          find_disparity_range(right, left, execution, {0, 0}, Infinity::kAnywhere)) {
    const DisparityRange other{-exchanged->max, -exchanged->min};
    range = range ? DisparityRange{std::min(range->min, other.min), std::max(range->max, other.max)}
                  : other;
  }
  if (range) {
    range->max = std::min(range->max, range->min + kMaxCandidates - 1);
  }
  return range;
}

std::optional<DisparityRange> range_of(const AspJob& job, const Photograph& left,
                                       const Photograph& right, Execution& execution) {
  if (!job.min_px) {
    return found_range(left, right, execution);
  }
  return job.sign == DisparitySign::kRightMinusLeft ? DisparityRange{-*job.max_px, -*job.min_px}
                                                    : DisparityRange{*job.min_px, *job.max_px};
}

/// Computes `map`. Returns why there is nothing to match; empty: `map` is computed.
std::string match(const AspJob& job, const DisparityMap& left, const DisparityMap& right,
                  Execution& execution, RunReport& report, DisparityMap& map) {
  if (!has_data(left.view()) || !has_data(right.view())) {
    return "an image has no data";
  }
  const Photograph left_image = photograph_without_gaps(left.view(), execution);
  const Photograph right_image = photograph_without_gaps(right.view(), execution);
  const auto range = report.timed_compute(
      "range", [&] { return range_of(job, left_image, right_image, execution); });
  if (!range) {
    return "the images have nothing in common";
  }
  MatchOptions options;
  options.preset = job.preset;
  options.disparities = *range;
  options.refinement.fill = Fill::kNone;
  const StereoMatcher matcher(options, execution);
  DisparityMaps maps;
  MatchReport matched;
  report.timed_compute(
      [&] { matcher.match(left_image, right_image, {.right = false}, maps, &matched); });
  tell_match(matched, job.common, report);
  tell_shares(matched, job.common, report);
  disparities_of_data(maps.left, left.view(), right.view(), execution, map);
  return {};
}

}  // namespace

int run_asp(const AspJob& job, const Settings& settings) {
  check(job, settings);
  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  Execution& execution = work.execution;

  DisparityMap left;
  DisparityMap right;
  report.timed_file_access("read", [&] {
    left = read_float_image(job.left);
    right = read_float_image(job.right);
  });
  const int width = left.width();
  const int height = left.height();
  if (right.width() != width || right.height() != height) {
    throw Error(fmt::format("{} is {}x{} but {} is {}x{}, expected equal sizes", job.left, width,
                            height, job.right, right.width(), right.height()));
  }
  DisparityMap map(width, height);
  const float sign = job.sign == DisparitySign::kRightMinusLeft ? -1 : 1;
  const std::string problem = match(job, left, right, execution, report, map);
  std::size_t known = 0;
  for (int y = 0; y < height; ++y) {
    std::transform(map.row(y), map.row(y) + width, map.row(y), [&](float d) {
      const float written = problem.empty() ? sign * d : std::numeric_limits<float>::quiet_NaN();
      known += std::isfinite(written) ? 1 : 0;
      return written;
    });
  }
  report.timed_file_access("write", [&] { write_disparity(job.output, map.view()); });
  const double share = static_cast<double>(known) / (static_cast<double>(width) * height);
  report.set_results({{"width_px", width}, {"height_px", height}, {"known_share", share}});
  report.write(job.common.report);
  if (!problem.empty()) {
    tell("asp: warning: {}: {} has no disparities\n", problem, job.output);
  }
  if (!job.common.quiet) {
    tell("asp: preset {}, {}x{} pixels, {:.1f} % of them with a disparity -> {}\n",
         name_of(job.preset), width, height, 100 * share, job.output);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
