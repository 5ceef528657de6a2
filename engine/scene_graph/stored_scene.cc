#include "engine/scene_graph/stored_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "engine/build_info.h"
#include "engine/error.h"
#include "engine/io/atomic_file.h"
#include "engine/io/disparity_io.h"
#include "engine/io/file_bytes.h"
#include "engine/io/file_identity.h"
#include "engine/io/json_text.h"
#include "engine/io/photograph_io.h"
#include "engine/io/stored_name.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kSceneFormat = 2;

constexpr const char* kSceneFile = "scene.json";

fs::path file_of(const fs::path& folder) { return folder / kSceneFile; }

Json json_of(const StoredFile& file) { return {{"file", file.name}, {"bytes", file.bytes}}; }

StoredFile file_of(const Json& json) {
  return {.name = json.at("file").get<std::string>(),
          .bytes = json.at("bytes").get_ref<const Json::number_unsigned_t&>()};
}

Json json_of(const StoredEdge& stored) {
  const SceneEdge& edge = stored.edge;
  return {{"first", edge.first},
          {"second", edge.second},
          {"direction", edge.is_vertical ? "y" : "x"},
          {"length", edge.length},
          {"slope", edge.slope},
          {"disparities", {stored.disparities.min, stored.disparities.max}},
          {"matched_share", stored.matched_share},
          {"rectification_error_px",
           stored.rectification_error_px ? Json(*stored.rectification_error_px) : Json()},
          {"maps", {json_of(stored.maps[0]), json_of(stored.maps[1])}},
          {"unmatched", {json_of(stored.unmatched[0]), json_of(stored.unmatched[1])}}};
}

StoredEdge edge_of(const Json& json, int vertices, const std::string& name) {
  StoredEdge stored;
  stored.edge = {.first = json.at("first").get<int>(),
                 .second = json.at("second").get<int>(),
                 .is_vertical = json.at("direction").get<std::string>() == "y",
                 .length = json.at("length").get<double>(),
                 .slope = json.at("slope").get<double>()};
  const auto is_vertex = [&](int number) { return number >= 0 && number < vertices; };
  if (!is_vertex(stored.edge.first) || !is_vertex(stored.edge.second) ||
      !(stored.edge.length > 0) || !(std::abs(stored.edge.slope) <= 1)) {
    throw Error(fmt::format("{}: an edge is out of range", name));
  }
  stored.disparities = {.min = json.at("disparities").at(0).get<int>(),
                        .max = json.at("disparities").at(1).get<int>()};
  stored.matched_share = json.at("matched_share").get<std::array<double, 2>>();
  if (!json.at("rectification_error_px").is_null()) {
    stored.rectification_error_px = json.at("rectification_error_px").get<double>();
  }
  for (std::size_t k = 0; k < 2; ++k) {
    stored.maps[k] = file_of(json.at("maps").at(k));
    stored.unmatched[k] = file_of(json.at("unmatched").at(k));
  }
  return stored;
}

StoredScene scene_of(std::string_view text, const std::string& name) {
  const Json json = parse_json(text, name);
  if (json.at("format").get<int>() != kSceneFormat) {
    throw Error(fmt::format("{}: is of format {}, expected {}", name,
                            quoted_json(json.at("format")), kSceneFormat));
  }
  StoredScene scene;
  scene.settings = json.at("settings").dump();
  scene.unit_length = json.at("unit_length").get<double>();
  scene.width_px = json.at("size").at(0).get<int>();
  scene.height_px = json.at("size").at(1).get<int>();
  for (const Json& image : json.at("images")) {
    scene.images.push_back(
        {.file = name_of_stored(image.at("file").get<std::string>()),
         .content = image.at("content").get<std::string>(),
         .position = {image.at("x").get<double>(), image.at("y").get<double>()}});
  }
  for (const Json& edge : json.at("edges")) {
    scene.edges.push_back(edge_of(edge, static_cast<int>(scene.images.size()), name));
  }
  if (!(scene.unit_length > 0) || !std::isfinite(scene.unit_length)) {
    throw Error(fmt::format("{}: unit_length is not above 0", name));
  }
  return scene;
}

std::string_view as_text(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

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

const StoredEdge* StoredScene::find(const SceneEdge& edge) const {
  const auto found = std::find_if(edges.begin(), edges.end(), [&](const StoredEdge& stored) {
    return stored.edge.first == edge.first && stored.edge.second == edge.second &&
           stored.edge.is_vertical == edge.is_vertical;
  });
  return found == edges.end() ? nullptr : &*found;
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
  const std::vector<std::uint8_t> bytes = read_file_bytes(file);
  Fnv1aHash hash;
  hash.add(as_text(bytes));
  return fmt::format("{} bytes, hash {:016x}", bytes.size(), hash.value());
}

std::optional<StoredScene> find_scene(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(file_of(folder), ignored)) {
    return std::nullopt;
  }
  const std::string name = file_of(folder).string();
  const std::vector<std::uint8_t> bytes = read_file_bytes(file_of(folder));
  try {
    return scene_of(as_text(bytes), name);
  } catch (const nlohmann::json::exception&) {
    throw Error(fmt::format("{}: is damaged, or not what 'vantage scene build' writes", name));
  }
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
  Json images = Json::array();
  for (const StoredImage& image : scene.images) {
    images.push_back({{"file", stored_name(image.file)},
                      {"x", image.position.x},
                      {"y", image.position.y},
                      {"content", image.content}});
  }
  Json edges = Json::array();
  for (const StoredEdge& edge : scene.edges) {
    edges.push_back(json_of(edge));
  }
  const Json json = {{"format", kSceneFormat},
                     {"version", build_info().version},
                     {"settings", parse_json(scene.settings, "settings")},
                     {"unit_length", scene.unit_length},
                     {"size", {scene.width_px, scene.height_px}},
                     {"images", images},
                     {"edges", edges}};
  write_text_file(file_of(folder), json.dump(1) + "\n");
}

void require_complete(const StoredScene& scene, const SceneLayout& layout, const fs::path& folder) {
  const auto missing =
      std::count_if(layout.edges().begin(), layout.edges().end(),
                    [&](const SceneEdge& edge) { return scene.find(edge) == nullptr; });
  if (missing > 0) {
    throw Error(
        fmt::format("{}: {} of {} edges are not matched yet, expected none; run the same 'vantage "
                    "scene build' to continue",
                    folder.string(), missing, layout.edges().size()));
  }
}

SceneVertex load_vertex(const fs::path& folder, const StoredScene& scene, int vertex) {
  const StoredImage& stored = scene.images.at(static_cast<std::size_t>(vertex));
  const fs::path image_file = folder / stored.file;
  std::error_code ignored;
  if (!fs::exists(image_file, ignored)) {
    throw Error(
        fmt::format("{} is missing, expected image {} of the scene; run 'vantage scene build' "
                    "after moving images, or with --copy-images to keep copies in the folder",
                    image_file.lexically_normal().string(), vertex));
  }
  if (content_of_file(image_file) != stored.content) {
    throw Error(
        fmt::format("{} has changed since its edges were matched, expected the same image; "
                    "'vantage scene build' matches them again",
                    image_file.string()));
  }
  SceneVertex result;
  result.image = read_photograph(image_file);
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
