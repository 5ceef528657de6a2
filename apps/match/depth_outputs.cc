#include "apps/match/depth_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/process/outputs.h"
#include "engine/error.h"
#include "engine/image/finite_values.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/maps/map_formats.h"
#include "engine/io/maps/map_io.h"
#include "engine/options/metric_settings.h"
#include "engine/order_statistics.h"
#include "engine/reprojection/ply_file.h"

namespace vantage::apps {
namespace {

/// Depths beyond what the file holds count as unknown.
double max_depth_in(const std::string& file, const CloudOptions& options) {
  return options.max_depth.value_or(largest_depth_m(file));
}

SettingValue depth_values(ImageView<const float> depth_m) {
  std::vector<float> known = finite_values(depth_m);
  const double pixels = static_cast<double>(depth_m.width()) * depth_m.height();
  SettingValue values = {{"known_share", static_cast<double>(known.size()) / pixels}};
  if (!known.empty()) {
    const auto [nearest, farthest] = std::minmax_element(known.begin(), known.end());
    values["min_m"] = *nearest;
    values["max_m"] = *farthest;
    values["median_m"] = upper_median(known);
  }
  return values;
}

}  // namespace

void add_depth_output_settings(Settings& settings, DepthOutputs& outputs) {
  settings.path("depth", outputs.depth, "FILE",
                fmt::format("Write the depth map: {}; PNG in millimetres (16 bits, 0 unknown), the "
                            "others in metres",
                            listed_map_formats(MapContent::kDepth)));
  settings.path(
      "cloud", outputs.cloud, "FILE.ply",
      "Write the pixels as points in metres, with their colours: x right, y down, z ahead "
      "of the left camera");
  settings.path("mesh", outputs.mesh, "FILE.ply",
                "Write the points as a surface of triangles, cut where the disparity jumps");
}

void check_depth_outputs(const DepthOutputs& outputs, const Settings& settings, FileChecks& files) {
  outputs.options.validate();
  if (!outputs.any()) {
    settings.refuse_idle({"max-depth"}, "without --depth, --cloud and --mesh");
  }
  if (!outputs.has_points()) {
    refuse_idle_cloud_options(settings, "without --cloud and --mesh");
  }
  const double limit_m = largest_depth_m(outputs.depth);
  if (outputs.options.max_depth && *outputs.options.max_depth > limit_m) {
    throw UsageError(
        fmt::format("--max-depth is {}, expected at most {} with a 16-bit PNG of millimetres",
                    *outputs.options.max_depth, limit_m));
  }
  files.add_output(outputs.depth, "--depth", OutputKind::kDepth);
  files.add_output(outputs.cloud, "--cloud", OutputKind::kPoints);
  files.add_output(outputs.mesh, "--mesh", OutputKind::kPoints);
}

DepthFiles make_depth_files(const DepthOutputs& outputs, const CloudSource& source,
                            Execution& execution, RunReport& report) {
  DepthFiles files;
  if (!outputs.depth.empty()) {
    Image<float> depth_m;
    depth_map(source.disparity_px, source.camera.scale,
              max_depth_in(outputs.depth, outputs.options), execution, depth_m);
    encode_depth(outputs.depth, depth_m.view(), files.depth, &execution);
    SettingValue values = depth_values(depth_m.view());
    const double share = values["known_share"].get<double>();
    files.summaries.push_back(
        values.contains("min_m")
            ? fmt::format(
                  "depths {:.4g} to {:.4g} m, median {:.4g} m, in {:.1f} % of the pixels -> {}",
                  values["min_m"].get<double>(), values["max_m"].get<double>(),
                  values["median_m"].get<double>(), 100 * share, outputs.depth)
            : fmt::format("no pixel has a depth: is the baseline {:.4g} m, or is "
                          "--calibration-unit another one? -> {}",
                          source.camera.scale.baseline, outputs.depth));
    report.add_result("depth", std::move(values));
  }
  if (!outputs.cloud.empty()) {
    const PointCloud cloud = point_cloud(source, outputs.options, execution);
    files.cloud = encode_ply(cloud, kCameraFrame);
    report.add_result("cloud", {{"points", cloud.size()}});
    files.summaries.push_back(fmt::format("{} points -> {}", cloud.size(), outputs.cloud));
  }
  if (!outputs.mesh.empty()) {
    const TriangleMesh mesh = triangle_mesh(source, outputs.options, execution);
    files.mesh = encode_ply(mesh, kCameraFrame);
    report.add_result(
        "mesh", {{"vertices", mesh.vertices.size()}, {"triangles", mesh.triangles.size() / 3}});
    files.summaries.push_back(fmt::format("{} vertices, {} triangles -> {}", mesh.vertices.size(),
                                          mesh.triangles.size() / 3, outputs.mesh));
  }
  return files;
}

void write_depth_files(const DepthOutputs& outputs, const DepthFiles& files) {
  for (const auto& [path, bytes] : {std::pair{&outputs.depth, &files.depth},
                                    {&outputs.cloud, &files.cloud},
                                    {&outputs.mesh, &files.mesh}}) {
    if (!path->empty()) {
      write_binary_file(*path, *bytes);
    }
  }
}

}  // namespace vantage::apps
