#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/inputs/kitti_cameras_choice.h"
#include "apps/inputs/map_camera_input.h"
#include "apps/match/depth_outputs.h"
#include "apps/process/command_work.h"
#include "apps/process/outputs.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/reports/run_report.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "engine/error.h"
#include "engine/image/eight_bit.h"
#include "engine/image/photograph_reading.h"
#include "engine/image/white_level.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/options/given_map_settings.h"
#include "engine/options/match_settings.h"
#include "engine/options/metric_settings.h"
#include "engine/options/pair_source_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

struct ReprojectJob {
  std::string map;
  std::string image;
  std::string unmatched;
  std::string confidence;
  GivenMapOptions given;
  Side reference = Side::kLeft;
  PhotographReading reading;
  MapCameraInput cameras;
  DepthOutputs outputs;
  CommonOptions common;
};

void add_reproject_settings(Settings& settings, ReprojectJob& job) {
  settings.start_group("Files");
  settings.positional("map", job.map, "Disparity map, or depth map (--given depth)").required =
      true;
  settings.input_path("image", job.image, "FILE",
                      "The rectified image of the map, for the colours of --cloud and --mesh; "
                      "without it they are grey");
  settings.input_path("unmatched", job.unmatched, "MASK.png",
                      "Mask of the pixels that were filled, as match --unmatched writes it");
  settings.input_path("confidence", job.confidence, "FILE",
                      "Confidence of the map, as match --confidence writes it");
  add_given_map_settings(settings, job.given);
  add_reference_setting(settings, job.reference);
  add_reading_settings(settings, job.reading);
  settings.start_group("Cameras");
  add_map_camera_settings(settings, job.cameras, RigUse::kPoints);
  settings.start_group("Output: at least one of these");
  add_depth_output_settings(settings, job.outputs);
  settings.start_group("Points");
  add_cloud_settings(settings, job.outputs.options);
}

void check(const ReprojectJob& job, const Settings& settings) {
  job.common.execution.validate();
  job.cameras.validate(settings);
  job.given.validate(settings);
  if (!job.outputs.any()) {
    throw UsageError(
        "there is nothing to write, expected at least one of --depth, --cloud and --mesh");
  }
  job.cameras.rig.require_given(job.cameras.calibration, job.outputs.first_option());
  if (!job.outputs.has_points()) {
    settings.refuse_idle({"image", "orientation", "unmatched", "confidence"},
                         "without --cloud and --mesh");
  }
  if (job.image.empty()) {
    settings.refuse_idle({"orientation"}, "without --image");
  }
  if (!job.outputs.reads_unmatched()) {
    settings.refuse_idle({"unmatched"}, "with --cloud-filled");
  }
  if (job.outputs.reads_confidence() == job.confidence.empty()) {
    throw UsageError(job.confidence.empty()
                         ? "--cloud-min-confidence and --cloud-confidence need --confidence FILE"
                         : "--confidence has no effect without --cloud-min-confidence and "
                           "--cloud-confidence");
  }
  FileChecks files(settings);
  check_depth_outputs(job.outputs, settings, files);
  check_common_files(job.common, files);
}

/// What belongs to the map.
struct MapFiles {
  DisparityMap disparity_px;
  Photograph image;
  Mask unmatched;
  Image<float> confidence;
};

MapFiles read_files(const ReprojectJob& job, Execution& execution, RunReport& report) {
  MapFiles files;
  std::vector<Remark> remarks;
  files.disparity_px = read_given_map(
      job.map, job.given,
      [&](int width, int height) { return job.cameras.camera(width, height, job.reference).scale; },
      execution, remarks);
  if (job.image.empty() && job.outputs.has_points()) {
    remarks.push_back({Remark::Kind::kNote, "cloud", "points are grey without `image`"});
  }
  tell_remarks(remarks, job.common, report);
  if (!job.image.empty()) {
    files.image = read_photograph(job.image, job.reading);
    Photograph* const image[] = {&files.image};
    tell_remarks(scale_to_white_level(image, {}), job.common, report);
  }
  if (!job.unmatched.empty()) {
    files.unmatched = eight_bit(read_photograph(job.unmatched));
    if (files.unmatched.channels() != 1) {
      throw Error(fmt::format("{}: has {} channels, expected a mask of 1", job.unmatched,
                              files.unmatched.channels()));
    }
  }
  if (!job.confidence.empty()) {
    files.confidence = read_disparity(job.confidence);
  }
  return files;
}

}  // namespace

int command_reproject(const Arguments& arguments) {
  ReprojectJob job;
  Settings settings("reproject",
                    "Turns a disparity map into depths, points or a surface in metres.");
  add_reproject_settings(settings, job);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"map", "image", "calibration", "focal-length", "baseline", "depth", "cloud", "mesh",
       "max-depth", "cloud-step", "threads", "quiet"},
      {"vantage reproject map.pfm --calibration calib.txt --depth depth.png",
       "vantage reproject map.pfm --image left.png --focal-length 720 --baseline 0.12 --cloud "
       "cloud.ply",
       "vantage reproject map.pfm --image left.png --calibration calib.txt --mesh mesh.ply "
       "--max-depth 20"});
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  check(job, settings);
  const std::filesystem::path image[] = {job.image};
  choose_kitti_cameras(settings, job.common, job.cameras.calibration, image,
                       job.cameras.calibration_choice);
  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  Execution& execution = work.execution;

  const MapFiles read =
      report.timed_file_access("read", [&] { return read_files(job, execution, report); });
  const int width = read.disparity_px.width();
  const int height = read.disparity_px.height();
  std::vector<Remark> remarks;
  const CloudSource source{.disparity_px = read.disparity_px.view(),
                           .colours = job.image.empty() ? nullptr : &read.image,
                           .unmatched = read.unmatched.view(),
                           .confidence = read.confidence.view(),
                           .camera = job.cameras.camera(width, height, job.reference, &remarks)};
  tell_remarks(remarks, job.common, report);
  const DepthFiles files = report.timed_compute(
      "depth", [&] { return make_depth_files(job.outputs, source, execution, report); });
  report.timed_file_access("write", [&] { write_depth_files(job.outputs, files); });
  report.write(job.common.report);
  if (!job.common.quiet) {
    tell("reproject: {}x{} pixels, focal length {:.6g} px, baseline {:.6g} m\n", width, height,
         source.camera.scale.focal_length_px, source.camera.scale.baseline);
    for (const std::string& summary : files.summaries) {
      tell("reproject: {}\n", summary);
    }
    report.print_summary();
  }
  return kExitDone;
}

}  // namespace vantage::apps
