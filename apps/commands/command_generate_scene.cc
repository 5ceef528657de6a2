#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/commands/commands.h"
#include "apps/match/generated_files.h"
#include "apps/process/command_work.h"
#include "apps/process/interrupt.h"
#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "apps/settings/toml_file.h"
#include "engine/error.h"
#include "engine/generation/layered_scene.h"
#include "engine/options/pose_file.h"
#include "engine/options/settings.h"
#include "engine/options/wanted_views.h"

namespace vantage::apps {
namespace {

struct SceneJob {
  LayeredSceneOptions scene;
  CommonOptions common;
  std::string output;
  std::optional<int> frames;
  double camera_speed = 0;  ///< baselines per frame
  std::vector<BaselinePosition> views;
  std::string pose_file;
  std::vector<PosedCamera> cameras;  ///< of the pose file
};

constexpr int kMaxFrames = 1000000;
constexpr const char* kCalibrationFile = "calib.txt";

void add_scene_settings(Settings& settings, SceneJob& job) {
  settings.start_group("Files");
  Setting& output = settings.path("output", job.output, "DIR", "Output folder");
  output.short_name = 'o';
  output.required = true;
  settings.integer("frames", job.frames, "N",
                   "Number of frames of a sequence (DIR/left/000000.png ...); single: one pair "
                   "(DIR/left.png ...)",
                   "single");
  add_view_setting(settings, job.views);
  settings.input_path("pose", job.pose_file, "FILE",
                      "Also render the cameras of this file of poses as camera-0, camera-1, ...; "
                      "the file is as for 'vantage synth', with t in baselines");

  settings.start_group("Scene");
  LayeredSceneOptions& scene = job.scene;
  settings.integer("width", scene.width_px, "PX", "Width of the images");
  settings.integer("height", scene.height_px, "PX", "Height of the images");
  settings.number("far", scene.far_disparity_px, "PX",
                  "Minimum disparity of the scene; auto: width / 80");
  settings.number("near", scene.near_disparity_px, "PX",
                  "Maximum disparity of the scene; auto: width / 16");
  settings.integer("frames-per-cycle", scene.frames_per_cycle, "N",
                   "Number of frames after which all movements repeat");
  settings.number("camera-speed", job.camera_speed, "B",
                  "Movement of both cameras to the right per frame, in baselines");
  settings.flag("boards", scene.has_boards,
                "Boards without texture, facing the cameras and slanted, in place of the other "
                "objects; DIR/left-uniform.png and right-uniform.png are white there");
  settings.integer("samples", scene.samples_per_side, "N", "Average N x N samples per pixel");
  settings.number("right-gain", scene.right_gain, "G",
                  "Gain of the right camera, whose intensity is G * I + O");
  settings.number("right-offset", scene.right_offset, "O",
                  "Offset of the right camera in grey levels; see --right-gain");
  settings.number("noise", scene.noise_sigma, "SIGMA",
                  "Standard deviation of the noise in all images, in grey levels");
  add_seed_setting(settings, scene.seed);
}

/// Views have the names that 'vantage run' uses, so that they can be compared file by file.
std::string view_name(const SceneJob& job, BaselinePosition view) {
  if (!job.frames) {
    return "view-" + to_string(view);
  }
  return job.views.size() == 1 ? "views" : "views/" + to_string(view);
}

std::string camera_name(std::size_t camera) { return fmt::format("camera-{}", camera); }

void check(const SceneJob& job, const Settings& settings) {
  job.scene.validate();
  if (!job.frames) {
    settings.refuse_idle({"frames-per-cycle", "camera-speed"}, "without --frames");
  }
  job.common.execution.validate();
  if (job.frames && (*job.frames < 1 || *job.frames > kMaxFrames)) {
    throw UsageError(
        fmt::format("--frames is {}, expected a number from 1 to {}", *job.frames, kMaxFrames));
  }
  if (job.camera_speed != 0) {
    for (const char* const name : {"view", "pose", "right-gain", "right-offset"}) {
      if (settings.is_set(name)) {
        throw UsageError(
            fmt::format("--{} is given with --camera-speed, expected one of them", name));
      }
    }
  }
  for (auto view = job.views.begin(); view != job.views.end(); ++view) {
    if (std::find(job.views.begin(), view, *view) != view) {
      throw UsageError(
          fmt::format("--view is {} twice, expected different positions", to_string(*view)));
    }
  }
}

void check_files(const SceneJob& job, const Settings& settings) {
  FileChecks files(settings);
  std::vector<std::string> names;
  for (const std::string side : {"left", "right"}) {
    for (const char* kind : {"", "-disparity", "-occluded"}) {
      names.push_back(side + kind);
    }
    if (job.scene.has_boards) {
      names.push_back(side + "-uniform");
    }
  }
  for (const BaselinePosition view : job.views) {
    names.push_back(view_name(job, view));
  }
  for (std::size_t camera = 0; camera < job.cameras.size(); ++camera) {
    names.push_back(camera_name(camera));
  }
  GeneratedFiles::check(job.output, job.frames.has_value(), names, files);
  files.add_made_file(std::filesystem::path(job.output) / kCalibrationFile, "--output");
  check_common_files(job.common, files);
}

std::vector<PosedCamera> cameras_of(const SceneJob& job) {
  std::vector<PosedCamera> cameras;
  if (job.pose_file.empty()) {
    return cameras;
  }
  for (const PoseEntry& entry : read_poses(job.pose_file, read_toml_document)) {
    const auto* camera = std::get_if<PosedCamera>(&entry.pose);
    if (camera == nullptr) {
      throw UsageError(
          fmt::format("{}: view {} is a position, expected cameras by K, R and t; "
                      "--view takes positions",
                      job.pose_file, cameras.size() + 1));
    }
    cameras.push_back(*camera);
    if (camera->width_px == 0) {
      cameras.back().width_px = job.scene.width_px;
      cameras.back().height_px = job.scene.height_px;
    }
  }
  return cameras;
}

void make_frame(const SceneJob& job, const LayeredScene& scene, int frame,
                const GeneratedFiles& files, RunReport& report) {
  const auto make_camera = [&](const std::string& name, SceneView camera, SceneView other) {
    const SceneRendering rendering =
        report.timed_compute("render", [&] { return scene.render(camera, frame); });
    const Mask occluded =
        report.timed_compute("occlusion", [&] { return scene.occlusion(camera, other, frame); });
    report.timed_file_access("write", [&] {
      files.write(name, frame, rendering.image);
      files.write(name + "-disparity", frame, rendering.disparity);
      files.write(name + "-occluded", frame, occluded);
      if (job.scene.has_boards) {
        files.write(name + "-uniform", frame, rendering.uniform);
      }
    });
  };
  const SceneView left{frame * job.camera_speed, 0};
  const SceneView right{left.x + 1, 0};
  make_camera("left", left, right);
  make_camera("right", right, left);
  const auto make_view = [&](const std::string& name, const PosedCamera& camera) {
    const SceneRendering rendering =
        report.timed_compute("render", [&] { return scene.render(camera, frame); });
    report.timed_file_access("write", [&] { files.write(name, frame, rendering.image); });
  };
  for (const BaselinePosition view : job.views) {
    make_view(view_name(job, view), scene.camera({view.x, view.y}));
  }
  for (std::size_t i = 0; i < job.cameras.size(); ++i) {
    make_view(camera_name(i), job.cameras[i]);
  }
}

/// In Middlebury's format, lengths in baselines.
std::string calibration_text(const LayeredScene& scene) {
  const PosedCamera camera = scene.camera({});
  const std::string matrix =
      fmt::format("[{} 0 {}; 0 {} {}; 0 0 1]", camera.matrix(0, 0), camera.matrix(0, 2),
                  camera.matrix(1, 1), camera.matrix(1, 2));
  return fmt::format("cam0={}\ncam1={}\ndoffs=0\nbaseline=1\nwidth={}\nheight={}\n", matrix, matrix,
                     camera.width_px, camera.height_px);
}

}  // namespace

int command_generate_scene(const Arguments& arguments) {
  SceneJob job;
  Settings settings(
      "generate scene",
      "Renders an artificial moving scene for both cameras, with its true disparities.");
  add_scene_settings(settings, job);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  settings.set_short_help(
      {"output", "frames", "view", "pose", "width", "height", "far", "near", "frames-per-cycle",
       "noise", "seed"},
      {"vantage generate scene -o scene", "vantage generate scene --frames 100 -o sequence",
       "vantage generate scene --view 0.5 --width 1280 --height 720 -o scene"});
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  check(job, settings);
  job.cameras = cameras_of(job);
  check_files(job, settings);
  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  Execution& execution = work.execution;
  const LayeredScene scene(job.scene, execution);
  const GeneratedFiles files(job.output, job.frames.has_value());

  report.timed_file_access("write",
                           [&] { files.write_text(kCalibrationFile, calibration_text(scene)); });
  const std::atomic<bool>& interrupted = interrupt_flag();
  const int frames = job.frames.value_or(1);
  int frames_done = 0;
  {
    Progress progress(
        "generate scene", "frames",
        job.common.quiet || frames == 1 ? ProgressStyle::kNone : ProgressStyle::kAuto);
    while (frames_done < frames && !interrupted.load()) {
      make_frame(job, scene, frames_done, files, report);
      progress.update(++frames_done, frames, 0);
    }
  }
  const int min_disparity = static_cast<int>(std::floor(job.scene.far_disparity_or_default()));
  const int max_disparity = static_cast<int>(std::ceil(job.scene.near_disparity_or_default()));
  work.finish({{"frames", frames_done},
               {"disparities", fmt::format("{}:{}", min_disparity, max_disparity)}},
              fmt::format("{} frame{} of {}x{} pixels, search with --disparities={}:{} -> {}",
                          frames_done, frames_done == 1 ? "" : "s", job.scene.width_px,
                          job.scene.height_px, min_disparity, max_disparity, job.output));
  return frames_done < frames ? kExitInterrupted : kExitDone;
}

}  // namespace vantage::apps
