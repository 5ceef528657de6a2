#include "engine/scene_graph/stored_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include "engine/error.h"
#include "engine/image/white_level.h"
#include "engine/io/files/atomic_file.h"
#include "engine/io/files/checksum.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/rectification/rows/row_correction.h"
#include "engine/scene_graph/scene_json.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSceneFile = "scene.json";

template <typename Picture>
void require_size(const fs::path& file, const Picture& picture, const Photograph& image) {
  if (picture.width() != image.width() || picture.height() != image.height()) {
    throw Error(fmt::format("{} is {}×{}, expected {}×{} as the image", file.string(),
                            picture.width(), picture.height(), image.width(), image.height()));
  }
}

DisparityMap read_map(const fs::path& file, const Photograph& image) {
  DisparityMap map = read_disparity(file);
  require_size(file, map, image);
  return map;
}

Mask read_mask(const fs::path& file, const Photograph& image) {
  Photograph picture = read_photograph(file);
  require_size(file, picture, image);
  auto* mask = std::get_if<Mask>(&picture.pixels);
  if (mask == nullptr || mask->channels() != 1) {
    throw Error(fmt::format("{} is not an 8-bit grey image, expected a mask", file.string()));
  }
  return std::move(*mask);
}

}  // namespace

Photograph StoredScene::read_image(const fs::path& file, int vertex, Execution& execution) const {
  Photograph image = read_photograph(file, reading);
  if (white_level) {
    WhiteLevel{image.pixels.index(), *white_level}.apply(image);
  }
  if (const auto& rows = images.at(static_cast<std::size_t>(vertex)).rows) {
    if (image.width() != rows->width() || image.height() != rows->height()) {
      throw Error(fmt::format("{}: is {}×{}, expected {}×{} as the scene", file.string(),
                              image.width(), image.height(), rows->width(), rows->height()));
    }
    Photograph corrected;
    correct_rows(image, *rows, corrected, execution);
    return corrected;
  }
  return image;
}

const StoredEdge* StoredScene::find(const SceneEdge& edge) const {
  const auto found = std::find_if(edges.begin(), edges.end(), [&](const StoredEdge& stored) {
    return stored.edge.first == edge.first && stored.edge.second == edge.second &&
           stored.edge.is_vertical == edge.is_vertical;
  });
  return found == edges.end() ? nullptr : &*found;
}

std::vector<SceneCamera> StoredScene::cameras() const {
  std::vector<SceneCamera> all;
  for (const StoredImage& image : images) {
    all.push_back(image.camera.value());
  }
  return all;
}

const RefusedEdge* StoredScene::find_refused(const SceneEdge& edge) const {
  const auto found = std::find_if(refused.begin(), refused.end(), [&](const RefusedEdge& one) {
    return one.first == edge.first && one.second == edge.second;
  });
  return found == refused.end() ? nullptr : &*found;
}

std::vector<ScenePosition> StoredScene::positions() const {
  std::vector<ScenePosition> all;
  for (const StoredImage& image : images) {
    all.push_back(image.position);
  }
  return all;
}

std::vector<fs::path> StoredScene::files() const {
  std::vector<fs::path> all = {kSceneFile};
  for (const StoredImage& image : images) {
    all.emplace_back(image.file);
  }
  for (const StoredEdge& edge : edges) {
    for (const auto& pair : {edge.maps, edge.unmatched}) {
      all.emplace_back(pair[0].name);
      all.emplace_back(pair[1].name);
    }
  }
  return all;
}

std::vector<std::string> StoredScene::names() const {
  std::vector<std::string> all;
  for (const StoredImage& image : images) {
    all.push_back(image.file);
  }
  return all;
}

std::string content_of_file(const fs::path& file) {
  const std::string bytes = read_file_text(file);
  Fnv1aHash hash;
  hash.add(bytes);
  return fmt::format("{} bytes, hash {:016x}", bytes.size(), hash.value());
}

std::optional<StoredScene> find_scene(const fs::path& folder) {
  std::error_code ignored;
  const fs::path file = folder / kSceneFile;
  if (!fs::exists(file, ignored)) {
    return std::nullopt;
  }
  return parse_scene(read_file_text(file), file.string());
}

StoredScene read_scene(const fs::path& folder) {
  std::optional<StoredScene> scene = find_scene(folder);
  if (!scene) {
    throw Error(fmt::format("{}: no scene, expected a folder written by 'vantage scene build'",
                            folder.string()));
  }
  return std::move(*scene);
}

void write_scene(const fs::path& folder, const StoredScene& scene) {
  write_text_file(folder / kSceneFile, scene_text(scene));
}

void require_complete(const StoredScene& scene, std::span<const SceneEdge> edges,
                      const fs::path& folder) {
  const auto missing = std::count_if(edges.begin(), edges.end(), [&](const SceneEdge& edge) {
    return scene.find(edge) == nullptr && scene.find_refused(edge) == nullptr;
  });
  if (missing > 0) {
    throw Error(
        fmt::format("{}: {} of {} edges are not matched yet, expected none; run the same 'vantage "
                    "scene build' to continue",
                    folder.string(), missing, edges.size()));
  }
}

SceneVertex load_vertex(const fs::path& folder, const StoredScene& scene, int vertex,
                        Execution& execution) {
  const StoredImage& stored = scene.images.at(static_cast<std::size_t>(vertex));
  const fs::path image_file = joined_path(folder, stored.file);
  if (!is_there(image_file)) {
    throw Error(fmt::format(
        "{} is missing, expected image {} of the scene; build the scene again "
        "after moving images, or with `copy-images` to keep copies in the folder",
        (is_address(image_file) ? image_file : image_file.lexically_normal()).string(), vertex));
  }
  if (content_of_file(image_file) != stored.content) {
    throw Error(
        fmt::format("{} has changed since its edges were matched, expected the same image; "
                    "'vantage scene build' matches them again",
                    image_file.string()));
  }
  SceneVertex result;
  result.image = scene.read_image(image_file, vertex, execution);
  for (const StoredEdge& edge : scene.edges) {
    for (std::size_t side = 0; side < 2; ++side) {
      const int ends[] = {edge.edge.first, edge.edge.second};
      if (ends[side] == vertex) {
        result.maps.push_back(
            {.neighbour = ends[1 - side],
             .length = edge.edge.length,
             .disparity_px = read_map(folder / edge.maps[side].name, result.image),
             .unmatched = read_mask(folder / edge.unmatched[side].name, result.image)});
      }
    }
  }
  return result;
}

}  // namespace vantage
