#include "apps/run/run_settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/inputs/frame_rate_setting.h"
#include "apps/inputs/input_limits.h"
#include "apps/inputs/rectification_check.h"
#include "apps/process/outputs.h"
#include "apps/run/stream_run.h"
#include "apps/settings/depth_video_settings.h"
#include "apps/settings/toml_file.h"
#include "engine/combinations/combinations.h"
#include "engine/io/maps/map_formats.h"
#include "engine/options/calibration_settings.h"
#include "engine/options/frame_step_setting.h"
#include "engine/options/match_settings.h"
#include "engine/options/metric_settings.h"
#include "engine/options/synthesis_settings.h"

namespace vantage::apps {
namespace {

constexpr int kMaxShards = 100000;

void add_output_settings(Settings& settings, RunJob& job) {
  settings.start_group("Output");
  Setting& output =
      settings.path("output", job.output, "DIR",
                    "Folder, such as DIR/disparity/000000.pfm; -: video on standard output");
  output.short_name = 'o';
  output.required = true;
  output.changes_results = false;
  add_save_setting(settings, job);
  Setting& video =
      settings.add("video", "LIST",
                   "Outputs to write as a video each: unmatched, right-unmatched, preview, "
                   "views, holes, sources, stereo, cyclopean-occlusion; depth-video is "
                   "one");
  video.list = true;
  video.set = [&job](const SettingValue& value) { job.sequence.video = to_outputs(value); };
  video.get = [&job] { return output_names(job.sequence.video); };
  add_picture_settings(settings, job);
  settings.text("format", job.sequence.map_format, "EXT",
                "File format of the maps: " + listed_map_formats(MapContent::kDisparity, ""));
  add_frame_rate_setting(settings, "fps", job.frame_rate,
                         "Frames per second of videos; auto: as the input, 25 for images");
  settings.integer("crf", job.sequence.crf, "N", "Constant rate factor of videos, 0 (best) to 51");
  add_depth_video_settings(settings, job.sequence.depth_scale, job.sequence.depth_coding);
  settings.choice<StreamFormat>(
      "stream-format", job.stream_format,
      {{"y4m", StreamFormat::kY4m}, {"rawvideo", StreamFormat::kRawVideo}},
      "Video on standard output: y4m (yuv420p, depth as mono16), or rawvideo (rgb24, depth as "
      "gray16le)");
  Setting& no_sound = settings.add("no-sound", "", "Do not copy the sound of the input");
  no_sound.kind = ValueKind::kTruth;
  no_sound.set = [&job](const SettingValue& value) { job.sequence.sound = !to_truth(value); };
  no_sound.get = [&job] { return !job.sequence.sound; };
}

void add_metric_settings(Settings& settings, RunJob& job) {
  settings.start_group("Depth, in metres");
  add_rig_scale_settings(settings, job.rig);
  settings.text(
      "depth-format", job.sequence.depth_format, "EXT",
      fmt::format("File format of depths: {}; png in millimetres (16 bits, 0 unknown), the "
                  "others in metres",
                  listed_map_formats(MapContent::kDepth, "")));
  add_disparity_resolution_setting(settings, job.sequence.disparity_step_px);
  add_cloud_settings(settings, job.sequence.cloud);
  add_poses_setting(settings, job);
}

void add_part_settings(Settings& settings, RunJob& job) {
  settings.start_group("Parts of a run, and resuming", false);
  add_frames_setting(settings, job.frames, job.step_of_frames);
  Setting& shard =
      settings.add("shard", "I/N", "Process part I of N only; all parts share one output folder");
  shard.set = [&job](const SettingValue& value) {
    if (value == "all") {
      job.shard.reset();
      return;
    }
    const auto numbers = two_numbers(to_text(value), '/');
    if (!numbers || numbers->first < 1 || numbers->first > numbers->second ||
        numbers->second > kMaxShards) {
      reject_value(value, "I/N with 1 <= I <= N such as 2/7, or all");
    }
    job.shard = Shard{numbers->first, numbers->second};
  };
  shard.get = [&job]() -> SettingValue {
    return job.shard ? fmt::format("{}/{}", job.shard->index, job.shard->count) : "all";
  };
  add_chunk_frames_setting(settings, job);
  settings.flag("resume", job.resume, "Continue the run in the output folder; needs only -o DIR");
  settings.flag("overwrite", job.overwrite, "Replace the run in the output folder");
  settings.flag("force", job.force, "Continue even if settings or inputs have changed");
  settings.flag("keep-going", job.keep_going, "Skip and record frames that fail; exit code 3");
}

void add_pipeline_settings(Settings& settings, RunJob& job) {
  settings.start_group("Pipeline", false);
  add_in_flight_setting(settings, job);
  add_live_setting(settings, job);
  add_size_setting(
      settings, "memory", job.memory_bytes,
      "Memory budget of the plan, such as 800M or 4G; auto: 80 % of what is free here, "
      "limits of control groups included");
  settings
      .flag("show", job.show,
            "Show the newest map, and the first view or the left image, in a window; q, Esc or "
            "closing it end the run as Ctrl-C does")
      .changes_results = false;
  settings.flag("dry-run", job.dry_run, "Print the plan and the time that it will take, and stop");
  settings.choice<ProgressStyle>("progress", job.progress,
                                 {{"auto", ProgressStyle::kAuto},
                                  {"bar", ProgressStyle::kBar},
                                  {"plain", ProgressStyle::kPlain},
                                  {"none", ProgressStyle::kNone}},
                                 "Progress as a bar, as a line every few seconds, or none; auto: a "
                                 "bar on a terminal, else lines");
}

}  // namespace

void add_run_settings(Settings& settings, RunJob& job) {
  add_input_settings(settings, job);
  add_unrectified_settings(settings, job.unrectified, job.rectified_pixels);
  add_calibration_choice_settings(settings, job.calibration_choice);
  add_rectification_check_setting(
      settings, job.check_rectification,
      "Do not check, and warn, whether rows correspond and whether left and right are exchanged");
  add_output_settings(settings, job);
  add_metric_settings(settings, job);
  add_steadiness_settings(settings, job);
  add_part_settings(settings, job);
  add_pipeline_settings(settings, job);
  add_reference_setting(settings, job.sequence.match.reference);
  add_match_settings(settings, job.sequence.match);
  add_synthesis_settings(settings, job.sequence.synthesis);
  add_tuning_settings(settings, job.tuning);
  add_common_settings(settings, job.common);
  add_pixel_limit_setting(settings);
  settings.set_short_help(
      {"left", "right", "stereo", "packing", "pairs", "calibration", "output", "save", "video",
       "view", "resume", "disparities", "preset"},
      {"vantage run --left left/ --right right/ -o results",
       "vantage run --stereo film.mp4 --packing sbsl --save preview --video preview -o results",
       "vantage run -o results --resume"});
}

void complete(RunJob& job, const Settings& settings) {
  read_pose_files(job.views, read_toml_document);
  complete_sequence(job, job.input.is_stream() || writes_stream(job));
  refuse_combinations(CombinationScope::kRun, values_of(job, settings));
  check_stream(job);
  job.input.raw_rate = job.frame_rate.value_or(FrameRate());
  check_sequence(job, settings);
  require_disparity_resolution(job.sequence.disparity_step_px);
  job.common.execution.validate();
}

std::filesystem::path slurm_folder(const std::filesystem::path& run_folder) {
  return run_folder / ".vantage" / "slurm";
}

void add_run_outputs(const SequenceLayout& layout, bool has_comfort, const std::string& option,
                     FileChecks& files) {
  files.add_made_folder(layout.journal_folder(), option);
  for (const OutputStream& stream : layout.streams()) {
    if (stream.as_video) {
      files.add_made_file(layout.video(stream), option);
    } else {
      files.add_made_folder(layout.folder() / stream.name, option);
    }
    if (stream.output == SequenceOutput::kDepthVideo) {
      files.add_made_file(layout.depth_description(), option);
    }
  }
  if (has_comfort) {
    files.add_made_file(layout.comfort_report("json"), option);
    files.add_made_file(layout.comfort_report("html"), option);
  }
}

FileChecks check_files(const RunJob& job, const Settings& settings) {
  FileChecks files(settings);
  files.add_input(file_of(job.tuning));
  if (writes_stream(job)) {
    check_common_files(job.common, files);
    return files;
  }
  const SequenceLayout layout(job.output, job.sequence);
  add_run_outputs(layout, job.sequence.saves(SequenceOutput::kComfort), "--output", files);
  if (job.overwrite) {
    files.add_made_folder(slurm_folder(job.output), "--overwrite");  // goes with the journal
  }
  check_common_files(job.common, files);
  return files;
}

}  // namespace vantage::apps
