#include "apps/run_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/cloud_settings.h"
#include "apps/depth_settings.h"
#include "apps/depth_video_settings.h"
#include "apps/frame_rate_setting.h"
#include "apps/frame_step_setting.h"
#include "apps/input_limits.h"
#include "apps/match_settings.h"
#include "apps/pair_source_settings.h"
#include "apps/rectification_check.h"
#include "apps/slurm_scripts.h"
#include "apps/stream_run.h"
#include "engine/error.h"
#include "engine/io/map_formats.h"

namespace vantage::apps {
namespace {

constexpr std::string_view kAutomatic = "auto";
constexpr int kMaxInFlight = 64;
constexpr int kMaxShards = 100000;

std::string known_outputs() {
  std::string names;
  for (const auto& [name, output] : sequence_output_names()) {
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

std::vector<SequenceOutput> to_outputs(const SettingValue& value) {
  std::vector<SequenceOutput> outputs;
  for (const SettingValue& member : to_list(value)) {
    for (const std::string& name : split(to_text(member), ',')) {
      const auto known = std::ranges::find(sequence_output_names(), name,
                                           &std::pair<std::string_view, SequenceOutput>::first);
      if (known == sequence_output_names().end()) {
        reject_value(name, "some of " + known_outputs());
      }
      if (std::ranges::find(outputs, known->second) == outputs.end()) {
        outputs.push_back(known->second);
      }
    }
  }
  return outputs;
}

SettingValue output_names(const std::vector<SequenceOutput>& outputs) {
  SettingValue names = SettingValue::array();
  for (const SequenceOutput output : outputs) {
    names.push_back(std::ranges::find(sequence_output_names(), output,
                                      &std::pair<std::string_view, SequenceOutput>::second)
                        ->first);
  }
  return names;
}

void add_input_settings(Settings& settings, RunJob& job) {
  settings.start_group("Input: one of --left with --right, --stereo, --pairs, --sequence");
  add_pair_source_settings(settings, job.input);
  Setting& more =
      settings.add("more", "SOURCE",
                   "With --left and --right: frames of a camera on the same line, whose "
                   "frame i belongs to left frame i; repeatable, needs --baselines");
  more.path = PathRole::kInput;
  more.list = true;
  more.changes_results = false;
  more.set = [&job](const SettingValue& value) {
    job.input.more.clear();
    for (const SettingValue& member : to_list(value)) {
      job.input.more.push_back(to_text(member));
    }
  };
  more.get = [&job] { return job.input.more; };
  add_baselines_setting(settings, job.sequence.baselines,
                        "Positions of the right camera and of those of --more, relative to the "
                        "left camera, positive to the right: all images of a frame are matched at "
                        "once; disparities are those of left and right");
  settings
      .input_path("calibration", job.calibration, "FILE",
                  "Cameras, to rectify the pairs first: OpenCV, Middlebury or KITTI file")
      .changes_results = false;  // the journal identifies inputs by their content
  add_rectification_check_setting(settings, job.check_rectification);
  settings.number("kept-outline", job.rectification.kept_outline, "SHARE",
                  "Area of rectified images: 0 only what both cameras see, 1 everything, with "
                  "black borders, which are matched like image content");
}

void add_stereo_views_setting(Settings& settings, std::array<double, 2>& views_x) {
  Setting& setting = settings.add("stereo-views", "XL,XR",
                                  "Positions of the two views of the stereo output, in baselines; "
                                  "0,1: the photographs themselves");
  setting.set = [&views_x](const SettingValue& value) {
    const auto parts = split(to_text(value), ',');
    try {
      if (parts.size() == 2) {
        views_x = {to_number(parts[0]), to_number(parts[1])};
        return;
      }
    } catch (const UsageError&) {
      // reported below
    }
    reject_value(value, "two positions on the baseline such as 0.25,0.75");
  };
  setting.get = [&views_x] { return fmt::format("{},{}", views_x[0], views_x[1]); };
}

void add_output_settings(Settings& settings, RunJob& job) {
  settings.start_group("Output");
  Setting& output =
      settings.path("output", job.output, "DIR",
                    "Folder, such as DIR/disparity/000000.pfm; -: video on standard output");
  output.short_name = 'o';
  output.required = true;
  output.changes_results = false;
  Setting& save = settings.add(
      "save", "LIST", "Outputs per frame: " + known_outputs() + "; auto: disparity and views");
  save.list = true;
  save.set = [&job](const SettingValue& value) {
    const auto members = to_list(value);
    if (members.size() == 1 && members.front() == kAutomatic) {
      job.save.reset();
    } else {
      job.save = to_outputs(value);
    }
  };
  save.get = [&job] { return job.save ? output_names(*job.save) : SettingValue(kAutomatic); };
  Setting& video = settings.add("video", "LIST",
                                "Outputs of --save to write as one video each, from unmatched, "
                                "right-unmatched, preview, views, holes, sources, stereo, "
                                "cyclopean-occlusion; depth-video always is one");
  video.list = true;
  video.set = [&job](const SettingValue& value) { job.sequence.video = to_outputs(value); };
  video.get = [&job] { return output_names(job.sequence.video); };
  add_sequence_view_settings(settings, job.views, job.sequence.look_at_px);
  add_stereo_views_setting(settings, job.sequence.stereo_views_x);
  settings.choice<StereoDisplay>("stereo-packing", job.sequence.stereo_packing,
                                 stereo_display_names(),
                                 "Layout of the stereo output: side by side, above/below, "
                                 "interleaved or anaglyph, using ffmpeg's stereo3d names");
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
  no_sound.flag = true;
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
  settings
      .input_path("poses", job.poses, "FILE",
                  "Poses of the left camera in metres, one per pair (TUM or KITTI trajectory): "
                  "clouds and meshes are in their world")
      .changes_results = false;  // the journal identifies inputs by their content
}

void add_steadiness_settings(Settings& settings, RunJob& job) {
  SequenceOptions& options = job.sequence;
  settings.start_group("Temporal stability");
  settings.choice<FitScope>("intensity-fit", options.intensity_fit,
                            {{"frame", FitScope::kFrame}, {"shot", FitScope::kShot}},
                            "Match the brightness of both images once per frame or once per shot");
  settings.choice<bool>("search-range", job.search_range_per_shot,
                        {{"film", false}, {"shot", true}},
                        "Search all frames in one range of disparities, or each shot in the range "
                        "found there; auto: shot for depth-video and comfort with --disparities "
                        "auto");
  settings.choice<bool>("preview-range", options.preview_range_per_shot,
                        {{"search", false}, {"shot", true}},
                        "Colour scale of previews: the search range or the disparities of a shot");
  settings.number("temporal-prior", options.temporal.weight, "W",
                  "Weight that keeps the disparity of unchanged pixels from frame to frame, 0 to "
                  "100; 0: off, 1: as strong as their own costs");
  settings.number("temporal-threshold", options.temporal.threshold, "G",
                  "A pixel counts as unchanged if it differs by at most this many grey levels");
  settings.choice<Reuse>("reuse", options.temporal.reuse,
                         {{"none", Reuse::kNone}, {"frame", Reuse::kFrame}},
                         "With presets and methods like theirs: frame keeps the disparities of the "
                         "frame before where the images do not change, which is faster and "
                         "steadier");
  settings.flag("measure-flicker", options.measure_flicker,
                "Measure how much results change where the images do not");
}

/// --frames A-B:N also says which frames are taken, for all parts of the run.
void apply_step_of_frames(RunJob& job) {
  if (!job.step_of_frames) {
    return;
  }
  const FrameStep step{.pairs = *job.step_of_frames,
                       .first = job.frames->first % *job.step_of_frames,
                       .seconds = std::nullopt};
  if (!job.input.every.takes_all() && job.input.every != step) {
    throw UsageError(fmt::format("--every is {} and --frames {}-{}:{}, expected one of the two",
                                 to_text(job.input.every), job.frames->first, job.frames->end - 1,
                                 *job.step_of_frames));
  }
  job.input.every = step;
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
  settings
      .integer("chunk-frames", job.sequence.chunk_frames, "N",
               "Frames per chunk, 1 to 100000. Parts of a run consist of whole chunks. Videos are "
               "written chunk by chunk, so an interruption loses one chunk at most. A temporal "
               "prior starts again with each chunk")
      .changes_results = true;
  settings.flag("resume", job.resume, "Continue the run in the output folder; needs only -o DIR");
  settings.flag("overwrite", job.overwrite, "Replace the run in the output folder");
  settings.flag("force", job.force, "Continue even if settings or inputs have changed");
  settings.flag("keep-going", job.keep_going, "Skip and record frames that fail; exit code 3");
}

void add_pipeline_settings(Settings& settings, RunJob& job) {
  settings.start_group("Pipeline", false);
  settings.integer(
      "in-flight", job.in_flight, "N",
      "Number of frames in flight, 1 to 64; auto: threads + 2, fewer if memory is short");
  add_size_setting(settings, "memory", job.memory_bytes,
                   "Memory budget of the plan, such as 800M or 4G; auto: no limit");
  settings.flag("dry-run", job.dry_run, "Print the plan and stop");
  settings.choice<ProgressStyle>("progress", job.progress,
                                 {{"auto", ProgressStyle::kAuto},
                                  {"bar", ProgressStyle::kBar},
                                  {"plain", ProgressStyle::kPlain},
                                  {"none", ProgressStyle::kNone}},
                                 "Progress as a bar, as a line every few seconds, or none; auto: a "
                                 "bar on a terminal, else lines");
}

/// Refuses options of outputs that are not written. `reads_rate`: --fps has a use without a video.
void refuse_idle_outputs(const Settings& settings, const SequenceOptions& sequence,
                         bool reads_rate) {
  using Output = SequenceOutput;
  const auto saves_any = [&](std::initializer_list<Output> outputs) {
    return std::ranges::any_of(outputs, [&](Output output) { return sequence.saves(output); });
  };
  const bool has_depth_video = sequence.saves(Output::kDepthVideo);
  if (sequence.video.empty() && !has_depth_video) {
    settings.refuse_idle({"crf", "no-sound"}, "without --video");
    if (!reads_rate) {
      settings.refuse_idle({"fps"}, "without --video");
    }
  }
  if (!has_depth_video) {
    settings.refuse_idle({"depth-range", "depth-codec"}, "where --save has no depth-video");
  }
  if (!saves_any({Output::kDisparity, Output::kRightDisparity, Output::kConfidence,
                  Output::kPosteriorMean, Output::kPosteriorVariance, Output::kCyclopean,
                  Output::kDepthResolution})) {
    settings.refuse_idle({"format"},
                         "where --save has no disparity, right-disparity, confidence, "
                         "posterior-mean, posterior-variance, cyclopean, depth-resolution");
  }
  if (!saves_any({Output::kDisparity, Output::kConfidence, Output::kUnmatched, Output::kPreview,
                  Output::kPosteriorMean, Output::kPosteriorVariance, Output::kDepth,
                  Output::kDepthResolution, Output::kCloud, Output::kMesh, Output::kDepthVideo,
                  Output::kComfort})) {
    settings.refuse_idle({"reference"},
                         "where --save has no disparity, confidence, unmatched, preview, "
                         "posterior-mean, posterior-variance, depth, depth-resolution, cloud, "
                         "mesh, depth-video, comfort");
  }
  if (!sequence.saves(Output::kDepth)) {
    settings.refuse_idle({"depth-format"}, "where --save has no depth");
  }
  if (!sequence.saves(Output::kDepthResolution)) {
    settings.refuse_idle({"disparity-resolution"}, "where --save has no depth-resolution");
  }
  if (!sequence.is_metric()) {
    settings.refuse_idle(
        {"baseline", "focal-length", "principal-point", "doffs", "calibration-unit"},
        "where --save has no depth, depth-resolution, cloud, mesh");
  }
  if (!sequence.saves(Output::kDepth) && !sequence.saves_points()) {
    settings.refuse_idle({"max-depth"}, "where --save has no depth, cloud, mesh");
  }
  if (!sequence.saves_points()) {
    refuse_idle_cloud_options(settings, "where --save has no cloud, mesh");
    settings.refuse_idle({"poses"}, "where --save has no cloud, mesh");
  }
  if (!sequence.saves(Output::kPreview)) {
    settings.refuse_idle({"preview-range"}, "where --save has no preview");
  }
  if (!sequence.saves(Output::kStereo)) {
    settings.refuse_idle({"stereo-views", "stereo-packing"}, "where --save has no stereo");
  }
  if (!saves_any({Output::kViews, Output::kHoles, Output::kSources, Output::kStereo})) {
    settings.refuse_idle({"intensity-fit", "warp", "holes", "soft-edges", "gamma", "gradient-limit",
                          "no-intensity-matching"},
                         "where --save has no views, holes, sources, stereo");
  }
  check_combining(settings, sequence.synthesis);
  if (!sequence.synthesis.match_intensities) {
    settings.refuse_idle({"intensity-fit"}, "with --no-intensity-matching");
  }
  if (!sequence.temporal.uses_past() && !sequence.measure_flicker) {
    settings.refuse_idle({"temporal-threshold"},
                         "without --temporal-prior, --reuse and --measure-flicker");
  }
}

/// Several cameras per frame.
void check_several(const RunJob& job, const Settings& settings) {
  if (job.sequence.baselines.empty() && job.input.more.empty()) {
    return;
  }
  if (job.input.left.empty() && !job.resume) {
    throw UsageError("--baselines has no effect without --left and --right");
  }
  check_baselines(settings, job.sequence.baselines, 1 + job.input.more.size());
  if (!job.calibration.empty()) {
    throw UsageError(
        "--calibration cannot be used with --baselines: it rectifies the images of two cameras "
        "only");
  }
}

}  // namespace

void add_run_settings(Settings& settings, RunJob& job) {
  settings.take_job_file();
  add_input_settings(settings, job);
  add_output_settings(settings, job);
  add_metric_settings(settings, job);
  add_steadiness_settings(settings, job);
  add_part_settings(settings, job);
  add_pipeline_settings(settings, job);
  add_reference_setting(settings, job.sequence.match);
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

void complete_sequence(RunJob& job) {
  SequenceOptions& sequence = job.sequence;
  sequence.views = paths_of(job.views);
  if (job.save) {
    sequence.save = *job.save;
  } else {
    sequence.save = {SequenceOutput::kDisparity};
    if (!sequence.views.empty()) {
      sequence.save.push_back(SequenceOutput::kViews);
    }
  }
  if (!job.search_range_per_shot && sequence.is_film()) {
    // Stays as it is when the range has been found, or the run is continued.
    job.search_range_per_shot = sequence.match.disparities_auto && !sequence.temporal.uses_past() &&
                                !reads_stream(job) && !writes_stream(job);
  }
  sequence.search_range_per_shot = job.search_range_per_shot.value_or(false);
  sequence.validate();
}

void complete(RunJob& job, const Settings& settings) {
  read_pose_files(job.views);
  complete_sequence(job);
  refuse_idle_outputs(settings, job.sequence, writes_stream(job) || job.input.raw_video);
  check_stream(job, settings);
  job.input.raw_rate = job.frame_rate.value_or(FrameRate());
  if (job.sequence.search_range_per_shot && settings.is_set("disparities") &&
      !job.sequence.match.disparities_auto) {
    throw UsageError("search-range is shot, expected film with a range in --disparities");
  }
  if (job.sequence.search_range_per_shot && job.memory_bytes) {
    throw UsageError(
        "search-range is shot, expected film with --memory, which plans for one range");
  }
  if (job.tuning.ignored) {
    settings.refuse_idle({"tuning"}, "with --no-tuning");
  }
  if (job.memory_bytes) {
    settings.refuse_idle({"tuning"}, "with --memory, for which the cost model plans");
  }
  check_several(job, settings);
  check_views(job.views, job.sequence.views, job.sequence.look_at_px, !job.calibration.empty());
  apply_step_of_frames(job);
  job.input.validate();
  job.rectification.validate();
  require_disparity_resolution(job.sequence.disparity_step_px);
  job.rig.validate(job.calibration);
  if (job.sequence.is_metric()) {
    job.rig.require_given(job.calibration, "save depth, depth-resolution, cloud or mesh");
  }
  if (job.rectification.kept_outline > 0 && job.calibration.empty()) {
    throw UsageError("--kept-outline has no effect without --calibration");
  }
  job.common.execution.validate();
  if (job.in_flight && (*job.in_flight < 1 || *job.in_flight > kMaxInFlight)) {
    throw UsageError(fmt::format("in-flight is {}, expected a number from 1 to {}", *job.in_flight,
                                 kMaxInFlight));
  }
  if (job.overwrite && (job.resume || job.force)) {
    throw UsageError(fmt::format("--overwrite and --{} are both given, expected one of them",
                                 job.resume ? "resume" : "force"));
  }
  if (job.overwrite && job.shard) {
    throw UsageError(
        "--overwrite with --shard would remove what other shards have done; remove the folder "
        "first, or use another one");
  }
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
