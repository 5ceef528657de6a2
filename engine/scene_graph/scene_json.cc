#include "engine/scene_graph/scene_json.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "engine/build_info.h"
#include "engine/error.h"
#include "engine/io/files/encoded_text.h"
#include "engine/io/files/json_text.h"
#include "engine/view_geometry/posed_camera.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSceneFormat = 2;
constexpr int kPosedFormat = 3;  // with cameras

Json json_of(const StoredFile& file) { return {{"file", file.name}, {"bytes", file.bytes}}; }

StoredFile file_of(const Json& json) {
  return {.name = json.at("file").get<std::string>(),
          .bytes = json.at("bytes").get_ref<const Json::number_unsigned_t&>()};
}

Json rows_of(const Eigen::Matrix3d& matrix) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) {
    rows.push_back({matrix(row, 0), matrix(row, 1), matrix(row, 2)});
  }
  return rows;
}

Json json_of(const SceneCamera& camera) {
  const Eigen::Vector3d& t = camera.pose.translation;
  Json json = {{"K", rows_of(camera.lens.matrix)},
               {"distortion", camera.lens.distortion},
               {"R", rows_of(camera.pose.rotation)},
               {"t", {t.x(), t.y(), t.z()}}};
  if (camera.lens.lens == LensKind::kFisheye) {
    json["lens"] = "fisheye";
  }
  return json;
}

Eigen::Matrix3d matrix_of(const Json& rows) {
  Eigen::Matrix3d matrix;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      matrix(row, column) =
          rows.at(static_cast<std::size_t>(row)).at(static_cast<std::size_t>(column)).get<double>();
    }
  }
  return matrix;
}

SceneCamera camera_of(const Json& json, const ImageSize& size, const std::string& name) {
  SceneCamera camera;
  camera.lens.matrix = matrix_of(json.at("K"));
  camera.lens.distortion = json.at("distortion").get<std::vector<double>>();
  camera.lens.lens =
      json.value("lens", "standard") == "fisheye" ? LensKind::kFisheye : LensKind::kStandard;
  camera.pose.rotation = matrix_of(json.at("R"));
  const auto t = json.at("t").get<std::array<double, 3>>();
  camera.pose.translation = {t[0], t[1], t[2]};
  camera.lens.validate(name + ": camera");
  PosedCamera{.matrix = camera.lens.matrix,
              .rotation = camera.pose.rotation,
              .translation = camera.pose.translation,
              .width_px = size.width_px,
              .height_px = size.height_px}
      .validate(name + ": camera");
  return camera;
}

Json json_of(const StoredEdge& stored) {
  const SceneEdge& edge = stored.edge;
  Json json = {{"first", edge.first},
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
  if (stored.corrected_degrees) {
    json["corrected_degrees"] = *stored.corrected_degrees;
  }
  return json;
}

/// The values that scenes of posed cameras have in addition.
void read_posed_values(const Json& json, const std::string& name, StoredScene& scene) {
  const int vertices = static_cast<int>(scene.images.size());
  const auto vertex = [&](const Json& number) {
    const int value = int_of(number);
    if (value < 0 || value >= vertices) {
      throw Error(fmt::format("{}: an edge is out of range", name));
    }
    return value;
  };
  scene.focal_length_px = json.at("focal_length_px").get<double>();
  if (!(scene.focal_length_px > 0)) {
    throw Error(fmt::format("{}: focal_length_px is not above 0", name));
  }
  for (const Json& edge : json.at("graph")) {
    scene.graph.push_back({.first = vertex(edge.at(0)),
                           .second = vertex(edge.at(1)),
                           .length = edge.at(2).get<double>()});
    if (!(scene.graph.back().length > 0)) {
      throw Error(fmt::format("{}: an edge is out of range", name));
    }
  }
  for (const Json& edge : json.at("refused")) {
    scene.refused.push_back({.first = vertex(edge.at("first")),
                             .second = vertex(edge.at("second")),
                             .reason = edge.at("reason").get<std::string>()});
  }
}

void add_posed_values(const StoredScene& scene, Json& json) {
  json["focal_length_px"] = scene.focal_length_px;
  Json graph = Json::array();
  for (const SceneEdge& edge : scene.graph) {
    graph.push_back({edge.first, edge.second, edge.length});
  }
  Json refused = Json::array();
  for (const RefusedEdge& edge : scene.refused) {
    refused.push_back({{"first", edge.first}, {"second", edge.second}, {"reason", edge.reason}});
  }
  json["graph"] = graph;
  json["refused"] = refused;
}

StoredEdge edge_of(const Json& json, int vertices, const std::string& name) {
  StoredEdge stored;
  stored.edge = {.first = int_of(json.at("first")),
                 .second = int_of(json.at("second")),
                 .is_vertical = json.at("direction").get<std::string>() == "y",
                 .length = json.at("length").get<double>(),
                 .slope = json.at("slope").get<double>()};
  const auto is_vertex = [&](int number) { return number >= 0 && number < vertices; };
  if (!is_vertex(stored.edge.first) || !is_vertex(stored.edge.second) ||
      !(stored.edge.length > 0) || !(std::abs(stored.edge.slope) <= 1)) {
    throw Error(fmt::format("{}: an edge is out of range", name));
  }
  stored.disparities = {.min = int_of(json.at("disparities").at(0)),
                        .max = int_of(json.at("disparities").at(1))};
  stored.matched_share = json.at("matched_share").get<std::array<double, 2>>();
  if (!json.at("rectification_error_px").is_null()) {
    stored.rectification_error_px = json.at("rectification_error_px").get<double>();
  }
  if (json.contains("corrected_degrees")) {
    stored.corrected_degrees = json.at("corrected_degrees").get<double>();
  }
  for (std::size_t k = 0; k < 2; ++k) {
    stored.maps[k] = file_of(json.at("maps").at(k));
    stored.unmatched[k] = file_of(json.at("unmatched").at(k));
  }
  return stored;
}

StoredScene scene_of(const Json& json, const std::string& name) {
  const int format = int_of(json.at("format"));
  if (format != kSceneFormat && format != kPosedFormat) {
    throw Error(fmt::format("{}: is of format {}, expected {} or {}", name,
                            quoted_json(json.at("format")), kSceneFormat, kPosedFormat));
  }
  StoredScene scene;
  scene.settings = json.at("settings").dump();
  scene.unit_length = json.at("unit_length").get<double>();
  scene.width_px = int_of(json.at("size").at(0));
  scene.height_px = int_of(json.at("size").at(1));
  if (json.contains("white_level")) {
    scene.white_level = json.at("white_level").get<double>();
    if (!(*scene.white_level > 0)) {
      throw Error(fmt::format("{}: white_level is not above 0", name));
    }
  }
  scene.reading.turns_upright = json.value("orientation", "upright") != "stored";
  if (json.contains("band")) {
    scene.reading.band = int_of(json.at("band"));
  }
  for (const Json& image : json.at("images")) {
    scene.images.push_back(
        {.file = name_of_stored(image.at("file").get<std::string>()),
         .content = image.at("content").get<std::string>(),
         .position = {image.at("x").get<double>(), image.at("y").get<double>()}});
    if (image.contains("rows")) {
      scene.images.back().rows =
          RowField(scene.width_px, scene.height_px, image.at("rows").get<RowField::Terms>());
      if (!(scene.images.back().rows->max_px() <= kMaxCorrection_px)) {
        throw Error(fmt::format("{}: rows of an image are out of range", name));
      }
    }
    if (format == kPosedFormat) {
      scene.images.back().camera =
          camera_of(image.at("camera"), {scene.width_px, scene.height_px}, name);
    }
  }
  if (format == kPosedFormat) {
    read_posed_values(json, name, scene);
  }
  for (const Json& edge : json.at("edges")) {
    scene.edges.push_back(edge_of(edge, static_cast<int>(scene.images.size()), name));
  }
  if (!(scene.unit_length > 0) || !std::isfinite(scene.unit_length)) {
    throw Error(fmt::format("{}: unit_length is not above 0", name));
  }
  return scene;
}

}  // namespace

std::string scene_text(const StoredScene& scene) {
  Json images = Json::array();
  for (const StoredImage& image : scene.images) {
    images.push_back({{"file", stored_name(image.file)},
                      {"x", image.position.x},
                      {"y", image.position.y},
                      {"content", image.content}});
    if (image.camera) {
      images.back()["camera"] = json_of(*image.camera);
    }
    if (image.rows) {
      images.back()["rows"] = image.rows->coefficients_px();
    }
  }
  Json edges = Json::array();
  for (const StoredEdge& edge : scene.edges) {
    edges.push_back(json_of(edge));
  }
  Json json = {{"format", scene.is_posed() ? kPosedFormat : kSceneFormat},
               {"version", build_info().version},
               {"settings", parse_json(scene.settings, "settings")},
               {"unit_length", scene.unit_length},
               {"size", {scene.width_px, scene.height_px}},
               {"images", images},
               {"edges", edges}};
  if (scene.white_level) {
    json["white_level"] = *scene.white_level;
  }
  if (!scene.reading.turns_upright) {
    json["orientation"] = "stored";
  }
  if (scene.reading.band) {
    json["band"] = *scene.reading.band;
  }
  if (scene.is_posed()) {
    add_posed_values(scene, json);
  }
  return json.dump(1) + "\n";
}

StoredScene parse_scene(std::string_view text, const std::string& name) {
  try {
    return scene_of(parse_json(text, name), name);
  } catch (const nlohmann::json::exception&) {
    throw Error(fmt::format("{}: is damaged, or not what 'vantage scene build' writes", name));
  }
}

}  // namespace vantage
