#include <fmt/format.h>

#include "apps/commands.h"
#include "apps/option_groups.h"
#include "apps/outputs.h"
#include "apps/run_report.h"
#include "apps/settings.h"
#include "engine/error.h"
#include "engine/io/disparity_io.h"
#include "engine/io/photograph_io.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/sequence/preview_range.h"
#include "engine/simd.h"

namespace vantage::apps {
namespace {

struct MatchJob {
  MatchOptions match;
  CommonOptions common;
  std::string left;
  std::string right;
  std::string output;
  std::string output_right;
  std::string unmatched;
  std::string preview;
};

void add_file_settings(Settings& settings, MatchJob& job) {
  settings.begin_group("Files");
  settings.positional("left", job.left, "Left image").required = true;
  settings.positional("right", job.right, "Right image of the same size").required = true;
  Setting& output = settings.text("output", job.output, "FILE",
                                  "Disparity map to write: .pfm .png .tiff .exr .npy");
  output.short_name = 'o';
  output.required = true;
  settings.text("output-right", job.output_right, "FILE", "Write the map of the right image too");
  settings.text("unmatched", job.unmatched, "MASK.png",
                "Write a mask of the pixels of the map that had no match");
  settings.text("preview", job.preview, "FILE",
                "Write the map as a picture whose colours span the search range");
}

void check(const MatchJob& job) {
  job.match.validate();
  job.common.execution.validate();
  if (job.match.reference == Reference::kRight && !job.output_right.empty()) {
    throw UsageError("--output-right cannot go with --reference right: --output is the right map");
  }
  FileChecks files;
  files.add_input(job.left);
  files.add_input(job.right);
  files.add_output(job.output, "--output", OutputKind::kDisparity);
  files.add_output(job.output_right, "--output-right", OutputKind::kDisparity);
  files.add_output(job.unmatched, "--unmatched", OutputKind::kMask);
  files.add_output(job.preview, "--preview", OutputKind::kPhotograph);
  files.add_output(job.common.report, "--report", OutputKind::kText);
}

void write_results(const MatchJob& job, const DisparityMaps& maps) {
  const bool is_left = job.match.reference == Reference::kLeft;
  const DisparityMap& map = is_left ? maps.left : maps.right;
  write_disparity(job.output, map.view());
  if (!job.output_right.empty()) {
    write_disparity(job.output_right, maps.right.view());
  }
  if (!job.unmatched.empty()) {
    write_mask(job.unmatched, (is_left ? maps.left_unmatched : maps.right_unmatched).view());
  }
  if (!job.preview.empty()) {
    const PreviewRange range = preview_range_of(job.match.disparities);
    write_photograph(job.preview, {colour_preview(map.view(), range.min_px, range.max_px)});
  }
}

}  // namespace

int command_match(const Arguments& arguments) {
  MatchJob job;
  Settings settings("match", "Computes the disparity map of a rectified stereo pair.");
  add_file_settings(settings, job);
  add_match_settings(settings, job.match);
  add_reference_setting(settings, job.match);
  add_common_settings(settings, job.common);
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  check(job);
  RunReport report(settings.command(), settings.values());
  force_instruction_set(job.common.isa);
  Execution execution(job.common.execution);
  report.set_execution(execution);
  const StereoMatcher matcher(job.match, execution);

  const Photograph left =
      report.timed_file_access("read", [&] { return read_photograph(job.left); });
  const Photograph right =
      report.timed_file_access("read", [&] { return read_photograph(job.right); });
  const bool right_is_primary = job.match.reference == Reference::kRight;
  DisparityMaps maps;
  const MatchReport match = report.timed_compute([&] {
    MatchReport result;
    const MatchRequest request{!right_is_primary, right_is_primary || !job.output_right.empty()};
    matcher.match(left, right, request, maps, &result);
    return result;
  });
  report.add_match(match);
  report.timed_file_access("write", [&] { write_results(job, maps); });

  report.write(job.common.report);
  if (!job.common.quiet) {
    fmt::print(stderr, "match: {}x{} pixels, disparities {}:{}, {} -> {}\n", left.width(),
               left.height(), job.match.disparities.min, job.match.disparities.max, job.left,
               job.output);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
