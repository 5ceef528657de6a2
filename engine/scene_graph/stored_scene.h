#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/image/photograph_reading.h"
#include "engine/matching/options/match_options.h"
#include "engine/rectification/rows/row_field.h"
#include "engine/scene_graph/scene_camera.h"
#include "engine/scene_graph/scene_layout.h"
#include "engine/scene_graph/scene_viewer.h"

namespace vantage {

/// An image of a stored scene.
struct StoredImage {
  std::string file;        ///< relative to the scene's folder, or absolute
  std::string content;     ///< content_of_file() of it
  ScenePosition position;  ///< of scenes without poses
  std::optional<SceneCamera> camera = std::nullopt;  ///< of scenes with poses
  /// By which its rows are corrected, see correct_rows(); none: as it is.
  std::optional<RowField> rows = std::nullopt;
};

/// A file of a scene's maps.
struct StoredFile {
  std::string name;  ///< relative to the scene's folder
  std::uint64_t bytes = 0;
};

/// A matched edge.
struct StoredEdge {
  SceneEdge edge;
  /// Search range, in pixels along rows or columns (of an oblique edge: the closer direction).
  DisparityRange disparities;
  /// Share of matched pixels in the first and the second image; the others are filled.
  std::array<double, 2> matched_share{};
  /// Misalignment of rows (columns): VerticalError::systematic_px. None if not measured, or too few
  /// points were found.
  std::optional<double> rectification_error_px;
  /// Angle by which the pose between posed cameras was corrected; none if it was used as given.
  std::optional<double> corrected_degrees = std::nullopt;
  /// Maps of the first and second image (.pfm) and their masks of unmatched pixels (.png).
  std::array<StoredFile, 2> maps;
  std::array<StoredFile, 2> unmatched;
};

/// An edge between posed cameras that the check refused: the scene does without it.
struct RefusedEdge {
  int first = 0;
  int second = 0;
  std::string reason;
};

/// Content of FOLDER/scene.json: images, their positions or cameras, and the edges matched so far.
struct StoredScene {
  std::string settings = "{}";  ///< a JSON object: the settings that affect maps
  int width_px = 0;             ///< of all images
  int height_px = 0;
  std::optional<double> white_level;  ///< of all images; empty: that of their type
  PhotographReading reading;
  /// SceneLayout::unit_length(), or median_length() of posed cameras.
  double unit_length = 1;
  /// Of posed cameras: maps hold focal_length_px · length of the edge / depth in the own camera.
  double focal_length_px = 1;
  std::vector<StoredImage> images;
  std::vector<StoredEdge> edges;
  /// Of posed cameras: all edges, matched or not, and those that were refused.
  std::vector<SceneEdge> graph = {};
  std::vector<RefusedEdge> refused = {};

  /// The image of a vertex, from its file: read_photograph() at the white level, with its rows
  /// corrected.
  [[nodiscard]] Photograph read_image(const std::filesystem::path& file, int vertex,
                                      Execution& execution) const;
  [[nodiscard]] bool is_posed() const { return !images.empty() && images[0].camera.has_value(); }
  /// Of a posed scene.
  [[nodiscard]] std::vector<SceneCamera> cameras() const;
  [[nodiscard]] const RefusedEdge* find_refused(const SceneEdge& edge) const;

  /// The finished edge between these vertices, if there is one.
  [[nodiscard]] const StoredEdge* find(const SceneEdge& edge) const;
  [[nodiscard]] std::vector<ScenePosition> positions() const;
  [[nodiscard]] std::vector<std::string> names() const;
  /// All files of the scene, relative to its folder: scene.json, images, maps and masks.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;
};

/// "1234 bytes, hash 00112233445566ff": equal for files of equal content. Throws Error when the
/// file cannot be read.
std::string content_of_file(const std::filesystem::path& file);

/// Empty when there is no scene. Throws Error naming the file when it is damaged or of another
/// format.
std::optional<StoredScene> find_scene(const std::filesystem::path& folder);
/// As find_scene(); Error when there is none.
StoredScene read_scene(const std::filesystem::path& folder);
/// Writes atomically. Throws Error.
void write_scene(const std::filesystem::path& folder, const StoredScene& scene);

/// Throws Error with the number of these edges that are neither matched nor refused, if any.
void require_complete(const StoredScene& scene, std::span<const SceneEdge> edges,
                      const std::filesystem::path& folder);

/// A vertex of a stored scene; of posed cameras, the image as its photograph, still distorted.
/// Identical for any `execution`.
/// Throws Error naming the file for an image that has changed since it was matched, and for maps
/// that are missing or of another size.
SceneVertex load_vertex(const std::filesystem::path& folder, const StoredScene& scene, int vertex,
                        Execution& execution = default_execution());

}  // namespace vantage
