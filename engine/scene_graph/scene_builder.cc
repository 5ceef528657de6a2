#include "engine/scene_graph/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

#include "engine/error.h"
#include "engine/image/transposed.h"
#include "engine/io/disparity_io.h"
#include "engine/io/photograph_io.h"
#include "engine/matching/disparity_range.h"

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

/// As the scene's folder sees it, so that folder and images can be moved together. A link to an
/// image stays one.
std::string path_from(const fs::path& folder, const fs::path& file) {
  const fs::path parent = fs::weakly_canonical(fs::absolute(file).parent_path());
  return (parent / file.filename())
      .lexically_relative(fs::weakly_canonical(fs::absolute(folder)))
      .generic_string();
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
    throw UsageError("--disparities-y has no use here: images of a scene are rectified");
  }
}

SceneBuilder::SceneBuilder(fs::path folder, std::vector<SceneImage> images,
                           SceneBuildOptions options, Execution& execution)
    : folder_(std::move(folder)),
      images_(std::move(images)),
      options_(std::move(options)),
      execution_(execution),
      layout_(positions_of(images_), names_of(images_)) {
  options_.validate();
  scene_.settings = nlohmann::ordered_json::parse(options_.settings).dump();
  scene_.unit_length = layout_.unit_length();
  std::error_code error;
  fs::create_directories(folder_ / "maps", error);
  if (error) {
    throw Error(fmt::format("{}: the folder cannot be made, {}", (folder_ / "maps").string(),
                            error.message()));
  }
  Photograph first;
  for (const SceneImage& image : images_) {
    Photograph photograph = read_photograph(image.file);
    if (&image == &images_.front()) {
      first = std::move(photograph);
    } else {
      require_same_shape(image, photograph, images_.front(), first);
    }
    scene_.images.push_back({.file = path_from(folder_, image.file),
                             .content = content_of_file(image.file),
                             .position = image.position});
  }
  keep_finished_edges();
}

void SceneBuilder::keep_finished_edges() {
  const std::optional<StoredScene> before = find_scene(folder_);
  const auto is_same_image = [&](int vertex) {
    const auto number = static_cast<std::size_t>(vertex);
    return number < before->images.size() &&
           before->images[number].content == scene_.images[number].content;
  };
  for (std::size_t i = 0; i < layout_.edges().size(); ++i) {
    const SceneEdge& edge = layout_.edges()[i];
    const StoredEdge* stored =
        before && before->settings == scene_.settings ? before->find(edge) : nullptr;
    if (stored != nullptr && is_same_image(edge.first) && is_same_image(edge.second) &&
        std::abs(stored->edge.length / before->unit_length / (edge.length / scene_.unit_length) -
                 1) <= kSameLength &&
        is_there(folder_, stored->maps[0]) && is_there(folder_, stored->maps[1]) &&
        is_there(folder_, stored->unmatched[0]) && is_there(folder_, stored->unmatched[1])) {
      scene_.edges.push_back(*stored);
      scene_.edges.back().edge = edge;
    } else {
      edges_to_match_.push_back(static_cast<int>(i));
    }
  }
  // Before any map is replaced: scene.json must never tell of one that is being made anew.
  write_scene(folder_, scene_);
  if (!before) {
    return;
  }
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
  for (const StoredEdge& edge : before->edges) {
    for_each_file(edge, [&](const std::string& name) {
      const fs::path path(name);
      if (!kept.contains(name) && path.parent_path() == "maps") {
        std::error_code ignored;
        fs::remove(folder_ / path, ignored);
      }
    });
  }
}

MatchOptions SceneBuilder::options_for(const SceneEdge& edge, const Photograph& first,
                                       const Photograph& second) const {
  MatchOptions options = options_.match;
  if (options.disparities_auto) {
    options.disparities = estimate_disparity_range(first, second, execution_);
    options.disparities_auto = false;
  } else {
    const double scale = edge.length / scene_.unit_length;
    const DisparityRange range = options.disparities;
    // A length like 0.1 · 3 must not widen a range by one.
    const auto outward = [&](double value) { return std::ceil(value * scale - 1e-6); };
    options.disparities = {.min = static_cast<int>(-outward(-range.min)),
                           .max = static_cast<int>(outward(range.max))};
  }
  options.validate();
  return options;
}

StoredEdge SceneBuilder::build(int edge, MatchReport* report) {
  const SceneEdge& wanted = layout_.edges().at(static_cast<std::size_t>(edge));
  const std::array<int, 2> ends = {wanted.first, wanted.second};
  std::array<Photograph, 2> images;
  for (std::size_t side = 0; side < 2; ++side) {
    images[side] = read_photograph(images_[static_cast<std::size_t>(ends[side])].file);
    if (wanted.is_vertical) {
      images[side] = transposed(images[side]);
    }
  }
  DisparityMaps maps;
  StoredEdge result;
  result.edge = wanted;
  try {
    const StereoMatcher matcher(options_for(wanted, images[0], images[1]), execution_);
    result.disparities = matcher.options().disparities;
    matcher.match(images[0], images[1], {}, maps, report);
  } catch (const UsageError&) {
    throw;
  } catch (const Error& error) {
    throw Error(
        fmt::format("{} and {}: {}", images_[static_cast<std::size_t>(ends[0])].file.string(),
                    images_[static_cast<std::size_t>(ends[1])].file.string(), error.what()));
  }
  const std::array<DisparityMap*, 2> disparities = {&maps.left, &maps.right};
  const std::array<Mask*, 2> masks = {&maps.left_unmatched, &maps.right_unmatched};
  for (std::size_t side = 0; side < 2; ++side) {
    if (wanted.is_vertical) {
      *disparities[side] = transposed(disparities[side]->view());
      *masks[side] = transposed(masks[side]->view());
    }
    const std::string name = fmt::format("maps/{:03}-{:03}-{}", wanted.first, wanted.second,
                                         side == 0 ? "first" : "second");
    const auto stored = [&](const std::string& file) {
      return StoredFile{.name = file, .bytes = fs::file_size(folder_ / file)};
    };
    write_disparity(folder_ / (name + ".pfm"), disparities[side]->view());
    result.maps[side] = stored(name + ".pfm");
    write_mask(folder_ / (name + "-unmatched.png"), masks[side]->view());
    result.unmatched[side] = stored(name + "-unmatched.png");
  }
  scene_.edges.push_back(result);
  // In the order of the layout, so that the file does not depend on interruptions.
  std::sort(scene_.edges.begin(), scene_.edges.end(), [](const auto& a, const auto& b) {
    return std::tuple(a.edge.first, a.edge.is_vertical, a.edge.second) <
           std::tuple(b.edge.first, b.edge.is_vertical, b.edge.second);
  });
  write_scene(folder_, scene_);
  return result;
}

}  // namespace vantage
