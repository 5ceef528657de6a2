#include <fmt/format.h>

#include <optional>

#include "apps/applied_tuning.h"
#include "apps/automatic_disparities.h"
#include "apps/commands.h"
#include "apps/option_groups.h"
#include "apps/outputs.h"
#include "apps/rectification_check.h"
#include "apps/run_report.h"
#include "apps/settings.h"
#include "engine/error.h"
#include "engine/io/disparity_io.h"
#include "engine/io/displacement_io.h"
#include "engine/io/photograph_io.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/sequence/preview_range.h"
#include "engine/simd.h"

namespace vantage::apps {
namespace {

struct MatchJob {
  MatchOptions match;
  CommonOptions common;
  TuningSource tuning;
  std::string left;
  std::string right;
  std::vector<std::string> more;  ///< images beyond the pair
  std::vector<double> baselines;  ///< of `right` and `more`; empty: a pair
  std::string output;
  std::string output_right;
  std::string confidence;
  std::string unmatched;
  std::string unmatched_right;
  std::string preview;
  bool check_rectification = true;

  [[nodiscard]] bool has_several() const { return !baselines.empty() || !more.empty(); }
  [[nodiscard]] std::vector<std::string> inputs() const {
    std::vector<std::string> all = {left, right};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Whether the map of the first image is one of a left image.
  [[nodiscard]] bool is_left() const {
    return has_several() ? baselines.front() > 0 : match.reference == Reference::kLeft;
  }
  [[nodiscard]] bool wants_right() const {
    return !is_left() || !output_right.empty() || !unmatched_right.empty();
  }
};

void add_several_settings(Settings& settings, MatchJob& job) {
  Setting& more = settings.add("more", "OTHER",
                               "More images of cameras on the same line, compared with the first");
  more.positional = true;
  more.list = true;
  more.set = [&job](const SettingValue& value) {
    std::vector<std::string> files;
    for (const SettingValue& member : to_list(value)) {
      files.push_back(to_text(member));
    }
    job.more = std::move(files);
  };
  more.get = [&job] { return job.more; };
  Setting& baselines = settings.add(
      "baselines", "B1,B2,...",
      "Where the cameras of all images but the first stand, from the first, to the right positive; "
      "disparities are those between the first two");
  baselines.set = [&job](const SettingValue& value) {
    std::vector<double> numbers;
    for (const SettingValue& member : to_list(value)) {
      if (member.is_string()) {
        for (const std::string& part : split(member.get<std::string>(), ',')) {
          numbers.push_back(to_number(part));
        }
      } else {
        numbers.push_back(to_number(member));
      }
    }
    job.baselines = std::move(numbers);
  };
  baselines.get = [&job] { return job.baselines; };
}

void add_file_settings(Settings& settings, MatchJob& job) {
  settings.begin_group("Files");
  settings.positional("left", job.left, "Left image; with --baselines the reference").required =
      true;
  settings.positional("right", job.right, "Right image of the same size").required = true;
  add_several_settings(settings, job);
  Setting& output = settings.text("output", job.output, "FILE",
                                  "Disparity map to write: .pfm .png .tiff .exr .npy; with "
                                  "--disparities-y the displacements: .flo .npy .tiff .exr");
  output.short_name = 'o';
  output.required = true;
  settings.text("output-right", job.output_right, "FILE", "Write the map of the right image too");
  settings.text("confidence", job.confidence, "FILE",
                "Write how sure the map is, before refinement: the evidence for cost gradient, the "
                "largest probability for bayes, the certainty for local-stopping, the winner's "
                "margin for others: .pfm .tiff .exr .npy");
  settings.text("unmatched", job.unmatched, "MASK.png",
                "Write a mask of the pixels of the map that had no match");
  settings.text("unmatched-right", job.unmatched_right, "MASK.png",
                "The same of the map of the right image");
  settings.text("preview", job.preview, "FILE",
                "Write the map as a picture whose colours span the search range");
  add_rectification_check_setting(settings, job.check_rectification);
}

void check_several(const MatchJob& job) {
  const std::size_t others = 1 + job.more.size();
  if (job.baselines.size() != others) {
    throw UsageError(
        fmt::format("--baselines has {} number{}, expected {}: one for each image but the first",
                    job.baselines.size(), job.baselines.size() == 1 ? "" : "s", others));
  }
  if (job.match.reference == Reference::kRight) {
    throw UsageError(
        "--reference right cannot go with --baselines: the first image is the reference");
  }
  if (!job.output_right.empty() || !job.unmatched_right.empty()) {
    throw UsageError(
        fmt::format("--{} cannot go with --baselines: there is a map of the first image only",
                    job.output_right.empty() ? "unmatched-right" : "output-right"));
  }
  if (job.match.disparities_y) {
    throw UsageError(
        "--disparities-y cannot go with --baselines: cameras on one line see no "
        "vertical disparities");
  }
}

void check(const MatchJob& job) {
  job.match.validate();
  job.common.execution.validate();
  if (job.has_several()) {
    check_several(job);
  } else if (job.match.reference == Reference::kRight &&
             !(job.output_right.empty() && job.unmatched_right.empty())) {
    throw UsageError(fmt::format("--{} cannot go with --reference right: {} is of the right map",
                                 job.output_right.empty() ? "unmatched-right" : "output-right",
                                 job.output_right.empty() ? "--unmatched" : "--output"));
  }
  if (has_extension(job.confidence, {".png"})) {
    throw UsageError(
        fmt::format("--confidence is '{}', but PNG holds no floats and confidences have no fixed "
                    "range, expected "
                    ".pfm .tiff .exr or .npy",
                    job.confidence));
  }
  const OutputKind map_kind =
      job.match.disparities_y ? OutputKind::kDisplacements : OutputKind::kDisparity;
  FileChecks files;
  for (const std::string& input : job.inputs()) {
    files.add_input(input);
  }
  files.add_output(job.output, "--output", map_kind);
  files.add_output(job.output_right, "--output-right", map_kind);
  files.add_output(job.confidence, "--confidence", OutputKind::kConfidence);
  files.add_output(job.unmatched, "--unmatched", OutputKind::kMask);
  files.add_output(job.unmatched_right, "--unmatched-right", OutputKind::kMask);
  files.add_output(job.preview, "--preview", OutputKind::kPhotograph);
  check_common_files(job.common, files);
}

void write_map(const MatchJob& job, const std::string& path, const DisparityMaps& maps,
               MapSide side) {
  const bool is_left = side == MapSide::kLeft;
  const DisparityMap& map = is_left ? maps.left : maps.right;
  if (!job.match.disparities_y) {
    write_disparity(path, map.view());
    return;
  }
  const DisparityMap& map_y = is_left ? maps.left_disparity_y : maps.right_disparity_y;
  write_displacements(path, {map.view(), map_y.view()}, side);
}

void write_results(const MatchJob& job, const DisparityMaps& maps) {
  const bool is_left = job.is_left();
  write_map(job, job.output, maps, is_left ? MapSide::kLeft : MapSide::kRight);
  if (!job.output_right.empty()) {
    write_map(job, job.output_right, maps, MapSide::kRight);
  }
  if (!job.confidence.empty()) {
    write_disparity(job.confidence,
                    (is_left ? maps.left_confidence : maps.right_confidence).view());
  }
  if (!job.unmatched.empty()) {
    write_mask(job.unmatched, (is_left ? maps.left_unmatched : maps.right_unmatched).view());
  }
  if (!job.unmatched_right.empty()) {
    write_mask(job.unmatched_right, maps.right_unmatched.view());
  }
  if (!job.preview.empty()) {
    const PreviewRange range = preview_range_of(job.match.disparities);
    const DisparityMap& map = is_left ? maps.left : maps.right;
    write_photograph(job.preview, {colour_preview(map.view(), range.min_px, range.max_px)});
  }
}

void require_equal_sizes(const MatchJob& job, const std::vector<Photograph>& images) {
  const std::vector<std::string> names = job.inputs();
  const Photograph& first = images.front();
  for (std::size_t i = 1; i < images.size(); ++i) {
    if (images[i].width() != first.width() || images[i].height() != first.height()) {
      throw Error(fmt::format("{} is {}x{} but {} is {}x{}, expected equal sizes", names[i],
                              images[i].width(), images[i].height(), names[0], first.width(),
                              first.height()));
    }
  }
}

void match_images(const MatchJob& job, const StereoMatcher& matcher,
                  const std::vector<Photograph>& images, DisparityMaps& maps, MatchReport& report) {
  const MatchRequest request{.left = job.is_left(),
                             .right = job.wants_right(),
                             .unmatched = !(job.unmatched.empty() && job.unmatched_right.empty()),
                             .confidence = !job.confidence.empty()};
  if (!job.has_several()) {
    matcher.match(images[0], images[1], request, maps, &report);
    return;
  }
  std::vector<OtherView> others;
  for (std::size_t i = 1; i < images.size(); ++i) {
    others.push_back({&images[i], job.baselines[i - 1]});
  }
  matcher.match_several(images[0], others, request, maps, &report);
}

}  // namespace

int command_match(const Arguments& arguments) {
  MatchJob job;
  Settings settings("match",
                    "Computes the disparity map of a rectified stereo pair, or of several images "
                    "taken on one line.");
  add_file_settings(settings, job);
  add_reference_setting(settings, job.match);
  add_match_settings(settings, job.match);
  add_tuning_settings(settings, job.tuning);
  add_common_settings(settings, job.common);
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  check(job);
  RunReport report(settings.command(), reported_settings(settings, job.match));
  report.start_trace(job.common.trace);
  force_instruction_set(job.common.isa);
  Execution execution(job.common.execution);
  report.set_execution(execution);

  std::vector<Photograph> images;
  for (const std::string& input : job.inputs()) {
    images.push_back(report.timed_file_access("read", [&] { return read_photograph(input); }));
  }
  require_equal_sizes(job, images);
  const bool first_is_left = !job.has_several() || job.is_left();
  const Photograph& left = images[first_is_left ? 0 : 1];
  const Photograph& right = images[first_is_left ? 1 : 0];
  if (job.check_rectification && !job.match.disparities_y) {
    warn_unless_rectified(settings, job.common, left, right, report);
  }
  choose_disparities(settings, job.common, left, right, job.match, execution, report);
  const AppliedTuning tuning = job.has_several()
                                   ? no_tuning("tuning is for pairs, there are more images")
                                   : apply_tuning(job.tuning,
                                                  {.match = job.match,
                                                   .execution = job.common.execution,
                                                   .left = left,
                                                   .right = right},
                                                  settings.command(), job.common.quiet);
  report.set_tuning(tuning.report, tuning.summary);
  std::optional<Execution> tuned_execution;
  if (tuning.settings != TunedSettings{}) {
    tuned_execution.emplace(with_tuned(job.common.execution, tuning.settings));
    report.set_execution(*tuned_execution);
  }
  const StereoMatcher matcher(job.match, tuned_execution ? *tuned_execution : execution);
  DisparityMaps maps;
  const MatchReport match = report.timed_compute([&] {
    MatchReport result;
    match_images(job, matcher, images, maps, result);
    return result;
  });
  report.add_match(match);
  report.timed_file_access("write", [&] { write_results(job, maps); });

  report.write(job.common.report);
  if (!job.common.quiet) {
    fmt::print(stderr, "match: {}x{} pixels, disparities {}:{}, {} -> {}\n", images[0].width(),
               images[0].height(), job.match.disparities.min, job.match.disparities.max, job.left,
               job.output);
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
