#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/matching/options/match_options.h"
#include "engine/scene_graph/scene_layout.h"
#include "engine/scene_graph/scene_viewer.h"

namespace vantage {

/// An image of a stored scene.
struct StoredImage {
  std::string file;     ///< relative to the scene's folder, or absolute
  std::string content;  ///< what content_of_file() says of it
  ScenePosition position;
};

/// A file that a scene's maps are in.
struct StoredFile {
  std::string name;  ///< relative to the scene's folder
  std::uint64_t bytes = 0;
};

/// An edge that has been matched.
struct StoredEdge {
  SceneEdge edge;
  /// That were searched, in pixels along rows or columns (of an oblique edge: whichever it is
  /// nearer to).
  DisparityRange disparities;
  /// Share of the first and the second image's pixels that were matched; the others are guesses.
  std::array<double, 2> matched_share{};
  /// How far rows (columns) are from corresponding: VerticalError::systematic_px. None where it was
  /// not looked for, or too few points were found.
  std::optional<double> rectification_error_px;
  /// Maps of the first and second image (.pfm) and their masks of unmatched pixels (.png).
  std::array<StoredFile, 2> maps;
  std::array<StoredFile, 2> unmatched;
};

/// What FOLDER/scene.json holds: images, where they stand, and the edges matched so far.
struct StoredScene {
  std::string settings = "{}";  ///< a JSON object: what maps depend on
  int width_px = 0;             ///< of all images
  int height_px = 0;
  double unit_length = 1;  ///< SceneLayout::unit_length()
  std::vector<StoredImage> images;
  std::vector<StoredEdge> edges;

  /// The finished edge between these vertices, if there is one.
  [[nodiscard]] const StoredEdge* find(const SceneEdge& edge) const;
  [[nodiscard]] std::vector<ScenePosition> positions() const;
  [[nodiscard]] std::vector<std::string> names() const;
  /// Everything that it is stored in, relative to its folder: scene.json, images, maps and masks.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;
};

/// "1234 bytes, hash 00112233445566ff": the same for equal files, wherever and whenever they are.
/// Throws Error when the file cannot be read.
std::string content_of_file(const std::filesystem::path& file);

/// Empty when there is no scene. Throws Error naming the file when it is damaged or of another
/// format.
std::optional<StoredScene> find_scene(const std::filesystem::path& folder);
/// The same; Error when there is none.
StoredScene read_scene(const std::filesystem::path& folder);
/// Whole or not at all. Throws Error.
void write_scene(const std::filesystem::path& folder, const StoredScene& scene);

/// Throws Error naming how many edges of `layout` are not in `scene`, unless all are.
void require_complete(const StoredScene& scene, const SceneLayout& layout,
                      const std::filesystem::path& folder);

/// A vertex of a stored scene. Throws Error naming the file for an image that has changed since it
/// was matched, and for maps that are missing or of another size.
SceneVertex load_vertex(const std::filesystem::path& folder, const StoredScene& scene, int vertex);

}  // namespace vantage
