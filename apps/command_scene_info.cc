#include <fmt/format.h>

#include "apps/commands.h"
#include "apps/settings.h"
#include "engine/scene_graph/stored_scene.h"

namespace vantage::apps {

int command_scene_info(const Arguments& arguments) {
  std::string folder;
  Settings settings("scene info", "Prints the images and edges of a scene.");
  settings.begin_group("Files");
  settings.positional("scene", folder, "Folder made by 'vantage scene build'").required = true;
  if (!settings.read(arguments)) {
    return kExitDone;
  }
  const StoredScene scene = read_scene(folder);
  const SceneLayout layout(scene.positions(), scene.names());
  fmt::print("images\n");
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const StoredImage& image = scene.images[i];
    fmt::print("  {:<4} {:>10.6g},{:<10.6g} {}\n", i, image.position.x, image.position.y,
               image.file);
  }
  fmt::print("edges\n");
  for (const SceneEdge& edge : layout.edges()) {
    const StoredEdge* stored = scene.find(edge);
    fmt::print("  {}-{} along {}, length {:.6g}, {}\n", edge.first, edge.second,
               edge.is_vertical ? "y" : "x", edge.length,
               stored == nullptr ? "not matched yet"
                                 : fmt::format("disparities {}:{}", stored->disparities.min,
                                               stored->disparities.max));
  }
  fmt::print("triangles\n");
  for (const auto& [a, b, c] : layout.triangles()) {
    fmt::print("  {}-{}-{}\n", a, b, c);
  }
  return kExitDone;
}

}  // namespace vantage::apps
