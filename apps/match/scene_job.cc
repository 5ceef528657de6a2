#include "apps/match/scene_job.h"

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
#include "apps/settings/toml_file.h"
#include "engine/error.h"
#include "engine/generation/layered_scene.h"
#include "engine/options/pose_file.h"
#include "engine/options/wanted_views.h"

namespace vantage::apps {
namespace {

constexpr int kMaxFrames = 1000000;
constexpr const char* kCalibrationFile = "calib.txt";

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
  files.require_nothing_made_unless(job.overwrite);
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

int generate_scene(SceneJob& job, const Settings& settings) {
  check(job, settings);
  job.cameras = cameras_of(job);
  check_files(job, settings);
  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  Execution& execution = work.execution;
  const LayeredScene scene(job.scene, execution);
  const GeneratedFiles files(job.output, job.frames.has_value());

  report.timed_file_access(
      "write", [&] { files.write_text(kCalibrationFile, calibration_text(scene), job.overwrite); });
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
