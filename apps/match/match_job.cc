#include "apps/match/match_job.h"

#include <fmt/format.h>

#include <tuple>
#include <utility>

#include "apps/inputs/input_limits.h"
#include "apps/process/outputs.h"
#include "engine/combinations/combinations.h"
#include "engine/error.h"
#include "engine/io/maps/map_formats.h"
#include "engine/io/maps/map_io.h"
#include "engine/matching/options/match_values.h"
#include "engine/matching/search/match_inputs.h"
#include "engine/options/pair_source_settings.h"
#include "engine/options/scene_mask_settings.h"

namespace vantage::apps {
namespace {

void add_several_settings(Settings& settings, MatchJob& job) {
  Setting& more =
      settings.add("more", "OTHER",
                   "More images from cameras on the same line; each is compared with the first");
  more.positional = true;
  more.path = PathRole::kInput;
  more.list = true;
  more.set = [&job](const SettingValue& value) {
    std::vector<std::string> files;
    for (const SettingValue& member : to_list(value)) {
      files.push_back(to_text(member));
    }
    job.more = std::move(files);
  };
  more.get = [&job] { return job.more; };
  add_baselines_setting(settings, job.baselines,
                        "Positions of the cameras of all images but the first, relative to the "
                        "first, positive to the right; disparities are x_left - x_right of the "
                        "first two images, of which the second is the left one if its position is "
                        "negative");
}

void add_file_settings(Settings& settings, MatchJob& job) {
  settings.start_group("Files");
  settings.positional("left", job.left, "Left image; with --baselines the reference image")
      .required = true;
  settings.positional("right", job.right,
                      "Right image of the same size; not with an MPO or JPS file");
  add_several_settings(settings, job);
  settings.flag("vertical", job.vertical,
                "Cameras one above the other: LEFT is the image of the upper one, --disparities "
                "are y_upper - y_lower, --disparities-y are x_upper - x_lower, and --baselines are "
                "positive downwards");
  add_unrectified_settings(settings, job.unrectified, job.rectified_pixels);
  Setting& output = settings.path(
      "output", job.output, "FILE",
      fmt::format("Path to the disparity map: {}; with --disparities-y displacements: {}",
                  listed_map_formats(MapContent::kDisparity),
                  listed_map_formats(MapContent::kDisplacements)));
  output.short_name = 'o';
  output.required = true;
  settings.path("output-right", job.output_right, "FILE",
                "Also write the disparity map of the right image");
  settings.path(
      "confidence", job.confidence, "FILE",
      fmt::format("Write the probability of each disparity to be within 1 px of the true one, "
                  "0 where it is unknown: {}",
                  listed_map_formats(MapContent::kConfidence)));
  settings.path("unmatched", job.unmatched, "MASK.png", "Write a mask of the unmatched pixels");
  settings.path("unmatched-right", job.unmatched_right, "MASK.png",
                "Write a mask of the unmatched pixels of the right map");
  settings.path("preview", job.preview, "FILE",
                "Write the map in false colours, scaled to the search range");
  settings.path("posterior-mean", job.posterior_mean, "FILE",
                fmt::format("With bayes and the presets but realtime: write the mean of each "
                            "pixel's p(d), before refinement: {}",
                            listed_map_formats(MapContent::kDisparity)));
  settings.path("posterior-variance", job.posterior_variance, "FILE",
                fmt::format("The same for the variance of p(d) in square pixels: {}",
                            listed_map_formats(MapContent::kConfidence)));
  settings.path("cyclopean", job.cyclopean, "FILE",
                fmt::format("With --selection symmetric: write the disparities of a camera in the "
                            "middle of both, unknown where one camera sees nothing: {}",
                            listed_map_formats(MapContent::kDisparity)));
  settings.path(
      "cyclopean-occlusion", job.cyclopean_occlusion, "MASK.png",
      "With --selection symmetric: write what sees the pixels of that camera: 0 both, 128 "
      "the left camera alone, 255 the right one alone, 64 no match");
  add_scene_mask_settings(settings, job.masks);
  add_volume_settings(settings, job.volume);
  add_white_level_setting(settings, job.white_level);
  add_reading_settings(settings, job.reading);
  add_row_settings(settings, job.rows);
}

void check_several(const MatchJob& job) {
  check_baselines(job.baselines, 1 + job.more.size());
  std::vector<OtherView> others;
  for (const double baseline : job.baselines) {
    others.push_back({nullptr, baseline});
  }
  require_different_baselines(others);
}

void check_posterior(const MatchJob& job, FileChecks& files) {
  if (!job.wants_posterior()) {
    return;
  }
  if (has_extension(job.posterior_variance, {".png"})) {
    throw UsageError(
        fmt::format("--posterior-variance is '{}', but PNG holds no floats, expected {}",
                    job.posterior_variance, listed_map_formats(MapContent::kConfidence)));
  }
  files.add_output(job.posterior_mean, "--posterior-mean", OutputKind::kDisparity);
  files.add_output(job.posterior_variance, "--posterior-variance", OutputKind::kConfidence);
}

void check_cyclopean(const MatchJob& job, FileChecks& files) {
  if (!job.wants_cyclopean()) {
    return;
  }
  files.add_output(job.cyclopean, "--cyclopean", OutputKind::kDisparity);
  files.add_output(job.cyclopean_occlusion, "--cyclopean-occlusion", OutputKind::kMask);
}

}  // namespace

void add_match_job_settings(Settings& settings, MatchJob& job) {
  add_file_settings(settings, job);
  add_reference_setting(settings, job.match.reference);
  add_depth_settings(settings, job.depth);
  add_match_settings(settings, job.match);
  add_tuning_settings(settings, job.tuning);
  add_common_settings(settings, job.common);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"left", "right", "more", "output", "output-right", "unmatched", "preview", "calibration",
       "depth", "cloud", "disparities", "preset", "threads", "quiet"},
      {"vantage match left.png right.png -o disparity.pfm --preview preview.png",
       "vantage match left.png right.png -o disparity.npy --disparities 0:127 --preset realtime",
       "vantage match left.png right.png -o disparity.png --fill none --unmatched mask.png",
       "vantage match left.png right.png -o map.pfm --calibration calib.txt --cloud cloud.ply"});
}

std::vector<std::string> MatchJob::written_maps() const {
  std::vector<std::string> files;
  for (const std::string* file : {&output, &output_right, &confidence, &unmatched, &unmatched_right,
                                  &preview, &posterior_mean, &posterior_variance, &cyclopean,
                                  &cyclopean_occlusion, &depth.resolution_file}) {
    if (!file->empty()) {
      files.push_back(*file);
    }
  }
  return files;
}

double MatchJob::disparity_resolution_px() const {
  return depth.step_px.value_or(vantage::disparity_resolution_px(match.resolved()));
}

void require_files_hold_search(const MatchJob& job) {
  if (job.match.disparities_auto) {
    return;
  }
  for (const std::string& file :
       {job.output, job.output_right, job.posterior_mean, job.cyclopean}) {
    require_holds_search(file, job.match.disparities.min, job.match.disparities.max);
  }
}

void check(const MatchJob& job, const Settings& settings) {
  job.match.validate();
  job.masks.validate();
  job.common.execution.validate();
  job.depth.validate(job.vertical);
  OptionValues values = settings.option_values();
  values.take(values_of(job.match));
  refuse_combinations(CombinationScope::kMatchJob, values);
  if (job.has_several()) {
    check_several(job);
  }
  for (const auto& [option, file, content] :
       {std::tuple{"confidence", &job.confidence, "confidences"},
        std::tuple{"depth-resolution", &job.depth.resolution_file, "distances"}}) {
    if (has_extension(*file, {".png"})) {
      throw UsageError(
          fmt::format("--{} is '{}', but PNG holds no floats and {} have no fixed "
                      "range, expected {}",
                      option, *file, content, listed_map_formats(MapContent::kConfidence)));
    }
  }
  const OutputKind map_kind =
      job.match.disparities_y ? OutputKind::kDisplacements : OutputKind::kDisparity;
  FileChecks files(settings);
  files.add_input(file_of(job.tuning));
  files.add_output(job.output, "--output", map_kind);
  files.add_output(job.output_right, "--output-right", map_kind);
  files.add_output(job.confidence, "--confidence", OutputKind::kConfidence);
  files.add_output(job.depth.resolution_file, "--depth-resolution", OutputKind::kConfidence);
  check_depth_outputs(job.depth.outputs, settings, files);
  files.add_output(job.unmatched, "--unmatched", OutputKind::kMask);
  files.add_output(job.unmatched_right, "--unmatched-right", OutputKind::kMask);
  files.add_output(job.preview, "--preview", OutputKind::kPhotograph);
  files.add_output(job.volume.file, "--volume", OutputKind::kVolume);
  check_volume(job.volume, job.match);
  check_posterior(job, files);
  check_cyclopean(job, files);
  check_common_files(job.common, files);
  require_files_hold_search(job);
}

}  // namespace vantage::apps
