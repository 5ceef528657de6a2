#include <fmt/format.h>

#include <string>

#include "apps/commands/commands.h"
#include "apps/settings/command_line.h"
#include "engine/options/settings.h"
#include "engine/quoted_text.h"
#include "engine/scene_graph/stored_scene.h"

namespace vantage::apps {
namespace {

std::string direction_of(const SceneEdge& edge) {
  const std::string axis = edge.is_vertical ? "along y" : "along x";
  return edge.slope == 0 ? axis : fmt::format("{}, slope {:.3g}", axis, edge.slope);
}

std::string text_of(const StoredEdge& edge) {
  return fmt::format("disparities {}:{}, matched {:.1f} and {:.1f} %{}{}", edge.disparities.min,
                     edge.disparities.max, 100 * edge.matched_share[0], 100 * edge.matched_share[1],
                     edge.rectification_error_px
                         ? fmt::format(", rectified to {:.2f} px", *edge.rectification_error_px)
                         : "",
                     edge.corrected_degrees ? fmt::format(", pose corrected by {:.2f} degrees",
                                                          *edge.corrected_degrees)
                                            : "");
}

void print_layout(const StoredScene& scene) {
  const SceneLayout layout(scene.positions(), scene.names());
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const StoredImage& image = scene.images[i];
    fmt::print("  {:<4} {:>10.6g},{:<10.6g} {}\n", i, image.position.x, image.position.y,
               image.file);
  }
  fmt::print("edges {}, {} of them matched\n", layout.edges().size(), scene.edges.size());
  for (const SceneEdge& edge : layout.edges()) {
    const StoredEdge* stored = scene.find(edge);
    fmt::print("  {}-{} {}, length {:.6g}, {}\n", edge.first, edge.second, direction_of(edge),
               edge.length, stored == nullptr ? "not matched yet" : text_of(*stored));
  }
  fmt::print("triangles {}\n", layout.triangles().size());
  for (const auto& [a, b, c] : layout.triangles()) {
    fmt::print("  {}-{}-{}\n", a, b, c);
  }
}

void print_posed(const StoredScene& scene) {
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const StoredImage& image = scene.images[i];
    const Eigen::Vector3d centre = image.camera->pose.centre();
    fmt::print("  {:<4} {:>10.6g},{:.6g},{:<10.6g} {}\n", i, centre.x(), centre.y(), centre.z(),
               image.file);
  }
  fmt::print("edges {}, {} of them matched, {} refused\n", scene.graph.size(), scene.edges.size(),
             scene.refused.size());
  for (const SceneEdge& edge : scene.graph) {
    const StoredEdge* stored = scene.find(edge);
    const RefusedEdge* refused = scene.find_refused(edge);
    std::string state = "not matched yet";
    if (stored != nullptr) {
      state = text_of(*stored);
    } else if (refused != nullptr) {
      state = "refused: " + printable(refused->reason);
    }
    fmt::print("  {}-{} length {:.6g}, {}\n", edge.first, edge.second, edge.length, state);
  }
}

}  // namespace

int command_scene_info(const Arguments& arguments) {
  std::string folder;
  Settings settings("scene info", "Prints the images and edges of a scene.");
  settings.start_group("Files");
  settings.positional("scene", folder, "Folder made by 'vantage scene build'").required = true;
  if (!read_command_line(settings, arguments)) {
    return kExitDone;
  }
  const StoredScene scene = read_scene(folder);
  fmt::print("images {}, {}x{} pixels\n", scene.images.size(), scene.width_px, scene.height_px);
  if (scene.is_posed()) {
    print_posed(scene);
  } else {
    print_layout(scene);
  }
  return kExitDone;
}

}  // namespace vantage::apps
