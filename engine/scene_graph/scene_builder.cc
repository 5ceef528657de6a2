#include "engine/scene_graph/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

#include "engine/error.h"
#include "engine/image/transposed.h"
#include "engine/io/atomic_file.h"
#include "engine/io/disparity_io.h"
#include "engine/io/file_bytes.h"
#include "engine/io/json_text.h"
#include "engine/io/photograph_io.h"
#include "engine/io/temporary_name.h"
#include "engine/matching/range_estimation.h"
#include "engine/order_statistics.h"
#include "engine/scene_graph/edge_check.h"
#include "engine/scene_graph/posed_edges.h"
#include "engine/scene_graph/rectified_edge.h"
#include "engine/scene_graph/sheared_images.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr double kSameLength = 1e-9;  // relative
constexpr std::size_t kHashDigits = 16;

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

void require_size_of_camera(const SceneImage& image, const Photograph& photograph) {
  const ImageSize size = image.camera_size;
  if (size.width_px != 0 &&
      (size.width_px != photograph.width() || size.height_px != photograph.height())) {
    throw Error(fmt::format("{} is {}×{}, expected {}×{} as its camera", image.file.string(),
                            photograph.width(), photograph.height(), size.width_px,
                            size.height_px));
  }
}

/// Relative to the scene's folder, so that folder and images can be moved together. Links to images
/// are not resolved.
std::string path_from(const fs::path& folder, const fs::path& file) {
  const fs::path parent = fs::weakly_canonical(fs::absolute(file).parent_path());
  return (parent / file.filename())
      .lexically_relative(fs::weakly_canonical(fs::absolute(folder)))
      .generic_string();
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw Error(fmt::format("{}: the folder cannot be made, {}", folder.string(), error.message()));
  }
}

/// Lock of the process that builds the scene.
fs::path lock_file(const fs::path& folder) {
  make_folder(folder / "maps");
  const fs::path file = folder / ".lock";
  create_text_file(file, "");
  return file;
}

/// "maps/003-004-first": file names of an edge's maps without extension.
std::string map_name(const SceneEdge& edge, std::size_t side) {
  return fmt::format("maps/{:03}-{:03}-{}", edge.first, edge.second,
                     side == 0 ? "first" : "second");
}

constexpr const char* kMapEnd = ".pfm";
constexpr const char* kMaskEnd = "-unmatched.png";

/// Converts pixels along x to pixels along the edge.
void scale(ImageView<float> disparity, double factor) {
  for (int y = 0; y < disparity.height(); ++y) {
    std::transform(disparity.row(y), disparity.row(y) + disparity.width(), disparity.row(y),
                   [&](float d) { return static_cast<float>(d * factor); });
  }
}

double matched_share_of(ImageView<const std::uint8_t> unmatched) {
  std::int64_t matched = 0;
  for (int y = 0; y < unmatched.height(); ++y) {
    matched += std::count(unmatched.row(y), unmatched.row(y) + unmatched.width(), 0);
  }
  return static_cast<double>(matched) /
         (static_cast<double>(unmatched.width()) * unmatched.height());
}

bool is_there(const fs::path& folder, const StoredFile& file) {
  std::error_code error;
  const auto bytes = fs::file_size(folder / file.name, error);
  return !error && bytes == file.bytes;
}

}  // namespace

void SceneBuildOptions::validate() const {
  match.validate();
  if (match.disparities_y) {
    throw UsageError("disparities-y is set, expected none: images of a scene are rectified");
  }
  if (neighbours < 1 || neighbours > kMaxNeighbours) {
    throw UsageError(fmt::format("neighbours is {}, expected a number from 1 to {}", neighbours,
                                 kMaxNeighbours));
  }
}

SceneBuilder::SceneBuilder(fs::path folder, std::vector<SceneImage> images,
                           SceneBuildOptions options, Execution& execution)
    : folder_(std::move(folder)),
      images_(std::move(images)),
      options_(std::move(options)),
      execution_(execution),
      layout_(layout_of(images_)),
      lock_(lock_file(folder_), FileLock::Wait::kNo) {
  options_.validate();
  if (!lock_.is_held()) {
    throw Error(
        fmt::format("{}: another process builds this scene, expected none", folder_.string()));
  }
  scene_.settings = parse_json(options_.settings, "settings").dump();
  if (options_.copy_images) {
    make_folder(folder_ / "images");
  }
  Photograph first;
  for (const SceneImage& image : images_) {
    Photograph photograph = read_photograph(image.file);
    require_size_of_camera(image, photograph);
    if (&image == &images_.front()) {
      first = std::move(photograph);
    } else {
      require_same_shape(image, photograph, images_.front(), first);
    }
    scene_.images.push_back(stored_image(image));
  }
  scene_.width_px = first.width();
  scene_.height_px = first.height();
  find_edges();
  remove_leftovers();
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

/// Unfinished files of a killed process. No other process uses the folder.
void SceneBuilder::remove_leftovers() const {
  remove_temporary_files_of(folder_ / "scene.json");
  std::set<std::string> maps;
  for (const SceneEdge& edge : edges_) {
    for (std::size_t side = 0; side < 2; ++side) {
      for (const char* end : {kMapEnd, kMaskEnd}) {
        maps.insert(fs::path(map_name(edge, side) + end).filename().string());
      }
    }
  }
  remove_temporary_files(folder_ / "maps",
                         [&](const std::string& name) { return maps.contains(name); });
}

StoredImage SceneBuilder::stored_image(const SceneImage& image) const {
  const std::string content = content_of_file(image.file);
  StoredImage stored{.file = path_from(folder_, image.file),
                     .content = content,
                     .position = image.position,
                     .camera = image.camera};
  const bool is_inside = fs::path(stored.file).begin()->string() != "..";
  if (!options_.copy_images || is_inside) {
    return stored;
  }
  // The end of the content's description is its hash.
  stored.file =
      fmt::format("images/{}-{}{}", image.file.stem().string(),
                  content.substr(content.size() - kHashDigits), image.file.extension().string());
  remove_temporary_files_of(folder_ / stored.file);
  std::error_code ignored;
  if (!fs::exists(folder_ / stored.file, ignored) ||
      content_of_file(folder_ / stored.file) != content) {
    write_binary_file(folder_ / stored.file, read_file_bytes(image.file));
  }
  return stored;
}

bool SceneBuilder::is_same_image(const StoredScene& before, int vertex) const {
  const auto number = static_cast<std::size_t>(vertex);
  return number < before.images.size() &&
         before.images[number].content == scene_.images[number].content &&
         before.images[number].camera == scene_.images[number].camera;
}

bool SceneBuilder::is_finished(const StoredEdge& stored, const StoredScene& before,
                               const SceneEdge& edge) const {
  return std::abs(stored.edge.length / before.unit_length / (edge.length / scene_.unit_length) -
                  1) <= kSameLength &&
         std::abs(stored.edge.slope - edge.slope) <= kSameLength &&
         is_there(folder_, stored.maps[0]) && is_there(folder_, stored.maps[1]) &&
         is_there(folder_, stored.unmatched[0]) && is_there(folder_, stored.unmatched[1]);
}

void SceneBuilder::keep_finished_edges() {
  const std::optional<StoredScene> before = find_scene(folder_);
  const bool is_same_work = before && before->settings == scene_.settings &&
                            before->focal_length_px == scene_.focal_length_px;
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
    remove_outdated_maps(*before);
  }
}

void SceneBuilder::remove_outdated_maps(const StoredScene& before) const {
  std::set<std::string> kept;
  const auto for_each_file = [](const StoredEdge& edge, const auto& body) {
    for (std::size_t side = 0; side < 2; ++side) {
      body(edge.maps[side].name);
      body(edge.unmatched[side].name);
    }
  };
  for (const StoredEdge& edge : scene_.edges) {
    for_each_file(edge, [&](const std::string& name) { kept.insert(name); });
  }
  for (const StoredEdge& edge : before.edges) {
    for_each_file(edge, [&](const std::string& name) {
      const fs::path path(name);
      if (!kept.contains(name) && path.parent_path() == "maps") {
        std::error_code ignored;
        fs::remove(folder_ / path, ignored);
      }
    });
  }
}

MatchOptions SceneBuilder::options_for(double scale, const Photograph& first,
                                       const Photograph& second) const {
  MatchOptions options = options_.match;
  if (options.disparities_auto) {
    options.disparities = estimate_disparity_range(first, second, execution_);
    options.disparities_auto = false;
    if (scene_.is_posed() && options.disparities.max > 0) {
      // Infinity is at 0: poses tell it.
      options.disparities.min = std::max(options.disparities.min, 0);
    }
  } else {
    const DisparityRange range = options.disparities;
    // Rounding errors of a length like 0.1 · 3 must not widen a range by one.
    const auto outward = [&](double value) { return std::ceil(value * scale - 1e-6); };
    options.disparities = {.min = static_cast<int>(-outward(-range.min)),
                           .max = static_cast<int>(outward(range.max))};
  }
  options.validate();
  return options;
}

DisparityMaps SceneBuilder::match(const std::array<Photograph, 2>& images, double scale,
                                  BuiltEdge& built, MatchReport* report) const {
  const StereoMatcher matcher(options_for(scale, images[0], images[1]), execution_);
  built.stored.disparities = matcher.in_force().disparities;
  DisparityMaps maps;
  matcher.match(images[0], images[1], {}, maps, report);
  return maps;
}

std::array<Photograph, 2> SceneBuilder::photographs_of(const SceneEdge& edge) const {
  return {read_photograph(image_file(edge.first)), read_photograph(image_file(edge.second))};
}

DisparityMaps SceneBuilder::posed_maps_of(BuiltEdge& built, MatchReport* report) const {
  const SceneEdge& edge = built.stored.edge;
  const auto camera = [&](int vertex) {
    return scene_.images[static_cast<std::size_t>(vertex)].camera.value();
  };
  const std::array<Photograph, 2> photographs = photographs_of(edge);
  const auto start = std::chrono::steady_clock::now();
  const RectifiedEdge rectified = rectify_edge(
      calibration_of(camera(edge.first), camera(edge.second), scene_.width_px, scene_.height_px),
      photographs, options_.check_rectification, execution_);
  if (options_.check_rectification) {
    built.check_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  built.rectification = rectified.error;
  built.stored.corrected_degrees = rectified.corrected_degrees;
  if (rectified.error) {
    built.stored.rectification_error_px = rectified.error->systematic_px;
  }
  const double scale =
      edge.length / scene_.unit_length * rectified.pair.focal_length_px() / scene_.focal_length_px;
  const DisparityMaps found = match(rectified.images, scale, built, report);
  built.stored.matched_share = {matched_share_of(found.left.unmatched.view()),
                                matched_share_of(found.right.unmatched.view())};
  if (options_.check_rectification) {
    require_checked_or_matched(built.stored.matched_share, built.rectification);
  }
  return {.left = rectified.pair.on_photograph(Side::kLeft, found.left, scene_.focal_length_px),
          .right = rectified.pair.on_photograph(Side::kRight, found.right, scene_.focal_length_px)};
}

DisparityMaps SceneBuilder::maps_of(BuiltEdge& built, MatchReport* report) const {
  const SceneEdge& edge = built.stored.edge;
  std::array<Photograph, 2> images = photographs_of(edge);
  for (Photograph& image : images) {
    if (edge.is_vertical) {
      image = transposed(image);
    }
  }
  const bool is_oblique = edge.slope != 0;
  const int height = images[0].height();
  const Shear shear(edge.slope, images[0].width());
  for (std::size_t side = 0; side < 2 && is_oblique; ++side) {
    images[side] = sheared(images[side], shear, execution_);
  }
  if (options_.check_rectification) {
    const auto start = std::chrono::steady_clock::now();
    built.rectification = require_rectified(images[0], images[1], lines_of(edge));
    if (built.rectification) {
      built.stored.rectification_error_px = built.rectification->systematic_px;
    }
    built.check_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  DisparityMaps maps = match(images, edge.length_along() / scene_.unit_length, built, report);
  const std::array<DisparityMap*, 2> disparities = {&maps.left.disparity_px,
                                                    &maps.right.disparity_px};
  const std::array<Mask*, 2> masks = {&maps.left.unmatched, &maps.right.unmatched};
  for (std::size_t side = 0; side < 2; ++side) {
    DisparityMap& disparity = *disparities[side];
    Mask& unmatched = *masks[side];
    if (is_oblique) {
      disparity = unsheared_disparity(disparity.view(), shear, height, execution_);
      unmatched = unsheared_mask(unmatched.view(), shear, height);
      mark_partners_beyond_border(disparity.view(), shear, side == 0 ? -1 : 1, unmatched.view());
      scale(disparity.view(), edge.length / edge.length_along());
    }
    if (edge.is_vertical) {
      disparity = transposed(disparity.view());
      unmatched = transposed(unmatched.view());
    }
    built.stored.matched_share[side] = matched_share_of(unmatched.view());
  }
  return maps;
}

void SceneBuilder::store(const DisparityMaps& maps, StoredEdge& result) {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const std::string name = map_name(result.edge, index_of(side));
    const auto stored = [&](const std::string& file) {
      return StoredFile{.name = file, .bytes = fs::file_size(folder_ / file)};
    };
    write_disparity(folder_ / (name + kMapEnd), maps.of(side).disparity_px.view());
    result.maps[index_of(side)] = stored(name + kMapEnd);
    write_mask(folder_ / (name + kMaskEnd), maps.of(side).unmatched.view());
    result.unmatched[index_of(side)] = stored(name + kMaskEnd);
  }
  scene_.edges.push_back(result);
  // In the order of the layout, so that the file does not depend on interruptions.
  std::sort(scene_.edges.begin(), scene_.edges.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.edge.first, a.edge.is_vertical, a.edge.second) <
           std::tuple(b.edge.first, b.edge.is_vertical, b.edge.second);
  });
}

SceneBuilder::BuiltEdge SceneBuilder::build(int edge, MatchReport* report) {
  BuiltEdge built;
  StoredEdge& result = built.stored;
  result.edge = edges_.at(static_cast<std::size_t>(edge));
  DisparityMaps maps;
  try {
    maps = scene_.is_posed() ? posed_maps_of(built, report) : maps_of(built, report);
    if (options_.check_rectification) {
      require_matched(result.matched_share, result.disparities, built.rectification);
    }
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
  store(maps, result);
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
          "{}: all its edges were refused, expected at least one; the one with "
          "{}: {}",
          image_file(vertex).string(),
          image_file(refused->first + refused->second - vertex).string(), refused->reason));
    }
  }
}

}  // namespace vantage
