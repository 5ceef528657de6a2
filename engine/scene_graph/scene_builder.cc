#include "engine/scene_graph/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "engine/error.h"
#include "engine/image/white_level.h"
#include "engine/io/files/json_text.h"
#include "engine/io/images/photograph_io.h"
#include "engine/order_statistics.h"
#include "engine/scene_graph/posed_edges.h"
#include "engine/scene_graph/scene_folder.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr double kSameLength = 1e-9;  // relative

std::vector<ScenePosition> positions_of(const std::vector<SceneImage>& images) {
  std::vector<ScenePosition> positions;
  for (const SceneImage& image : images) {
    positions.push_back(image.position);
  }
  return positions;
}

std::vector<std::string> names_of(const std::vector<SceneImage>& images) {
  std::vector<std::string> names;
  for (const SceneImage& image : images) {
    names.push_back(image.file.string());
  }
  return names;
}

/// Of cameras without poses.
std::optional<SceneLayout> layout_of(const std::vector<SceneImage>& images) {
  if (!images.empty() && images[0].camera) {
    return std::nullopt;
  }
  return SceneLayout(positions_of(images), names_of(images));
}

void require_same_shape(const SceneImage& image, const Photograph& photograph,
                        const SceneImage& first, const Photograph& first_photograph) {
  const auto describe = [](const Photograph& shape) {
    constexpr std::array kDepths = {"8-bit", "16-bit", "float"};
    return fmt::format("{}×{}, {} channel{}, {}", shape.width(), shape.height(), shape.channels(),
                       shape.channels() == 1 ? "" : "s", kDepths.at(shape.pixels.index()));
  };
  const std::string is = describe(photograph);
  const std::string expected = describe(first_photograph);
  if (is != expected) {
    throw Error(fmt::format("{} is {}, expected {} as {}", image.file.string(), is, expected,
                            first.file.string()));
  }
}

/// Scales the camera where it is for another size of the photograph.
void fit_camera(SceneImage& image, const Photograph& photograph, std::vector<Remark>& remarks) {
  const ImageSize size = image.camera_size;
  if (size.width_px != 0 &&
      (size.width_px != photograph.width() || size.height_px != photograph.height())) {
    image.camera_size = {photograph.width(), photograph.height()};
    if (const auto scaled = SizedCamera{image.camera->lens, size}.scaled_to(image.camera_size)) {
      image.camera->lens = *scaled;
      if (remarks.empty() || remarks.back().subject != "camera") {
        remarks.push_back({.kind = Remark::Kind::kNote,
                           .subject = "camera",
                           .text = fmt::format("cameras are for images of {}x{} and are scaled to "
                                               "{}x{}",
                                               size.width_px, size.height_px, photograph.width(),
                                               photograph.height())});
      }
      return;
    }
    throw Error(fmt::format("{} is {}×{}, expected {}×{} as its camera", image.file.string(),
                            photograph.width(), photograph.height(), size.width_px,
                            size.height_px));
  }
}

}  // namespace

SceneBuilder::SceneBuilder(fs::path folder, std::vector<SceneImage> images,
                           SceneBuildOptions options, Execution& execution)
    : folder_(std::move(folder)),
      images_(std::move(images)),
      options_(std::move(options)),
      execution_(execution),
      layout_(layout_of(images_)),
      lock_(scene_lock_file(folder_), FileLock::Wait::kNo) {
  options_.validate();
  if (!lock_.is_held()) {
    throw Error(
        fmt::format("{}: another process builds this scene, expected none", folder_.string()));
  }
  scene_.settings = parse_json(options_.settings, "settings").dump();
  WhiteLevelSearch white(options_.white_level);
  Photograph first;
  for (SceneImage& image : images_) {
    Photograph photograph = read_photograph(image.file, options_.reading);
    fit_camera(image, photograph, remarks_);
    white.add(photograph);
    if (&image == &images_.front()) {
      first = std::move(photograph);
    } else {
      require_same_shape(image, photograph, images_.front(), first);
    }
    scene_.images.push_back(stored_image(image));
  }
  WhiteLevel level = white.found();
  if (level.scales(first)) {
    scene_.white_level = level.value;
  }
  std::ranges::move(level.remarks, std::back_inserter(remarks_));
  scene_.reading = options_.reading;
  scene_.width_px = first.width();
  scene_.height_px = first.height();
  find_edges();
  correct_rows();
  remove_leftovers(folder_, edges_);
  keep_finished_edges();
}

void SceneBuilder::find_edges() {
  if (layout_) {
    edges_ = layout_->edges();
    scene_.unit_length = layout_->unit_length();
    return;
  }
  const std::vector<SceneCamera> cameras = scene_.cameras();
  edges_ = posed_edges(cameras, names_of(images_), scene_.width_px, scene_.height_px,
                       options_.neighbours);
  scene_.graph = edges_;
  scene_.unit_length = median_length(edges_);
  std::vector<double> focal_lengths_px;
  for (const SceneCamera& camera : cameras) {
    focal_lengths_px.push_back(std::sqrt(camera.lens.matrix(0, 0) * camera.lens.matrix(1, 1)));
  }
  scene_.focal_length_px = upper_median(focal_lengths_px);
}

void SceneBuilder::correct_rows() {
  if (!layout_ || options_.rows == RowMode::kAsIs || !options_.check_rectification) {
    return;
  }
  std::vector<fs::path> files;
  for (const SceneImage& image : images_) {
    files.push_back(image.file);
  }
  corrected_ = correct_scene_rows(scene_, edges_, files, execution_);
  for (const CorrectedImage& image : corrected_) {
    remarks_.push_back(image.remark);
  }
}

StoredImage SceneBuilder::stored_image(const SceneImage& image) const {
  const std::string content = content_of_file(image.file);
  return {.file = stored_image_file(folder_, image.file, content, options_.copy_images),
          .content = content,
          .position = image.position,
          .camera = image.camera};
}

bool SceneBuilder::is_same_image(const StoredScene& before, int vertex) const {
  const auto number = static_cast<std::size_t>(vertex);
  return number < before.images.size() &&
         before.images[number].content == scene_.images[number].content &&
         before.images[number].camera == scene_.images[number].camera &&
         before.images[number].rows == scene_.images[number].rows;
}

bool SceneBuilder::is_finished(const StoredEdge& stored, const StoredScene& before,
                               const SceneEdge& edge) const {
  return std::abs(stored.edge.length / before.unit_length / (edge.length / scene_.unit_length) -
                  1) <= kSameLength &&
         std::abs(stored.edge.slope - edge.slope) <= kSameLength && has_maps(folder_, stored);
}

void SceneBuilder::keep_finished_edges() {
  const std::optional<StoredScene> before = find_scene(folder_);
  const bool is_same_work =
      before && before->settings == scene_.settings && before->white_level == scene_.white_level &&
      before->reading == scene_.reading && before->focal_length_px == scene_.focal_length_px;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const SceneEdge& edge = edges_[i];
    const bool are_same_images =
        is_same_work && is_same_image(*before, edge.first) && is_same_image(*before, edge.second);
    const StoredEdge* stored = are_same_images ? before->find(edge) : nullptr;
    const RefusedEdge* refused =
        are_same_images && options_.check_rectification ? before->find_refused(edge) : nullptr;
    if (stored != nullptr && is_finished(*stored, *before, edge)) {
      scene_.edges.push_back(*stored);
      scene_.edges.back().edge = edge;
    } else if (refused != nullptr) {
      scene_.refused.push_back(*refused);
    } else {
      edges_to_match_.push_back(static_cast<int>(i));
    }
  }
  // Before any map is replaced: scene.json must never list one that is being rewritten.
  write_scene(folder_, scene_);
  if (before) {
    remove_outdated_maps(folder_, *before, scene_);
  }
}

void SceneBuilder::add(const StoredEdge& stored) {
  scene_.edges.push_back(stored);
  // In the order of the layout, so that the file does not depend on interruptions.
  std::sort(scene_.edges.begin(), scene_.edges.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.edge.first, a.edge.is_vertical, a.edge.second) <
           std::tuple(b.edge.first, b.edge.is_vertical, b.edge.second);
  });
}

BuiltEdge SceneBuilder::build(int edge, MatchReport* report) {
  BuiltEdge built;
  StoredEdge& result = built.stored;
  result.edge = edges_.at(static_cast<std::size_t>(edge));
  const EdgeMaps edge_maps(options_, images_, scene_, execution_);
  // What cannot be read now is no property of the edge, to be remembered.
  std::array<Photograph, 2> photographs = edge_maps.photographs_of(result.edge);
  DisparityMaps maps;
  try {
    maps = edge_maps.match(std::move(photographs), built, report);
  } catch (const UsageError&) {
    throw;
  } catch (const Error& error) {
    if (!scene_.is_posed()) {
      throw Error(fmt::format("{} and {}: {}", image_file(result.edge.first).string(),
                              image_file(result.edge.second).string(), error.what()));
    }
    built.refusal = error.what();
    scene_.refused.push_back(
        {.first = result.edge.first, .second = result.edge.second, .reason = built.refusal});
    std::sort(scene_.refused.begin(), scene_.refused.end(), [](const auto& a, const auto& b) {
      return std::pair(a.first, a.second) < std::pair(b.first, b.second);
    });
    write_scene(folder_, scene_);
    return built;
  }
  store_maps(folder_, maps, result);
  add(result);
  write_scene(folder_, scene_);
  return built;
}

void SceneBuilder::require_all_joined() const {
  for (int vertex = 0; vertex < images(); ++vertex) {
    const auto meets = [&](int first, int second) { return first == vertex || second == vertex; };
    const bool is_joined = std::any_of(
        scene_.edges.begin(), scene_.edges.end(),
        [&](const StoredEdge& edge) { return meets(edge.edge.first, edge.edge.second); });
    const auto refused =
        std::find_if(scene_.refused.begin(), scene_.refused.end(),
                     [&](const RefusedEdge& edge) { return meets(edge.first, edge.second); });
    if (!is_joined && refused != scene_.refused.end()) {
      throw Error(fmt::format(
          "{}: all its edges were refused, expected at least one; the one with {}: {}",
          image_file(vertex).string(),
          image_file(refused->first + refused->second - vertex).string(), refused->reason));
    }
  }
}

}  // namespace vantage
