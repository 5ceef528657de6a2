#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/process/command_work.h"
#include "apps/process/interrupt.h"
#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "apps/reports/run_report.h"
#include "apps/settings/command_line.h"
#include "apps/settings/common_options.h"
#include "engine/io/files/atomic_file.h"
#include "engine/options/settings.h"
#include "engine/reprojection/ply_file.h"
#include "engine/scene_graph/scene_cloud.h"
#include "engine/scene_graph/stored_scene.h"

namespace vantage::apps {
namespace {

struct SceneCloudJob {
  std::string scene;
  std::string output;
  SceneCloudOptions cloud;
  CommonOptions common;
};

void add_scene_cloud_settings(Settings& settings, SceneCloudJob& job) {
  settings.start_group("Files");
  settings.positional("scene", job.scene, "Folder made by 'vantage scene build --poses'").required =
      true;
  Setting& output = settings.path(
      "output", job.output, "FILE.ply",
      "Path to the points: with colours and normals, in the frame and the unit of the poses");
  output.short_name = 'o';
  output.required = true;
  settings.start_group("Points");
  settings.integer("min-images", job.cloud.min_images, "N",
                   "Keep points that at least N images see at the same depth, 1 to 32");
  settings.number("depth-tolerance", job.cloud.tolerance_px, "PX",
                  "Tolerance for agreeing depths of different images, in pixels of disparity over "
                  "the median baseline");
  settings.number("max-depth", job.cloud.max_depth, "DEPTH",
                  "Discard points farther than this from their camera, in the unit of the poses; "
                  "auto: no limit");
  settings.integer("cloud-step", job.cloud.step_px, "N",
                   "Points of every Nth column and row, 1 to 1024");
}

void check(const SceneCloudJob& job, const Settings& settings, const StoredScene& scene) {
  FileChecks files(settings);
  for (const std::filesystem::path& file : scene.files()) {
    files.add_input(std::filesystem::path(job.scene) / file);
  }
  files.add_output(job.output, "--output", OutputKind::kPoints);
  check_common_files(job.common, files);
}

}  // namespace

int command_scene_cloud(const Arguments& arguments) {
  SceneCloudJob job;
  Settings settings("scene cloud", "Fuses the maps of a scene with poses to one point cloud.");
  add_scene_cloud_settings(settings, job);
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help({"scene", "output", "min-images", "depth-tolerance", "max-depth",
                           "cloud-step", "threads", "quiet"},
                          {"vantage scene cloud scene -o cloud.ply",
                           "vantage scene cloud scene -o cloud.ply --min-images 2 --cloud-step 2"});
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  job.cloud.validate();
  job.common.execution.validate();
  const StoredScene scene = read_scene(job.scene);
  check(job, settings, scene);

  CommandWork work(settings, job.common);
  RunReport& report = work.report;
  Execution& execution = work.execution;
  SceneCloudMaker maker(
      scene, [&](int vertex) { return load_vertex(job.scene, scene, vertex, execution); },
      job.cloud, execution);
  require_complete(scene, scene.graph, job.scene);
  const int images = static_cast<int>(scene.images.size());
  {
    Progress progress("scene cloud", "images",
                      job.common.quiet ? ProgressStyle::kNone : ProgressStyle::kAuto);
    int done = 0;
    while (report.timed_compute("fuse", [&] { return maker.add_image(); })) {
      progress.update(++done, images, 0);
      if (interrupt_flag().load()) {
        return kExitInterrupted;
      }
    }
  }
  const PointCloud cloud = maker.finish();
  report.timed_file_access("write",
                           [&] { write_binary_file(job.output, encode_ply(cloud, kPoseFrame)); });
  return work.finish({{"images", images}, {"points", cloud.size()}},
                     fmt::format("{} images, {} points -> {}", images, cloud.size(), job.output));
}

}  // namespace vantage::apps
