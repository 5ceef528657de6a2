#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/io/file_lock.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/rectification/vertical_error.h"
#include "engine/scene_graph/scene_layout.h"
#include "engine/scene_graph/stored_scene.h"

namespace vantage {

/// An input image of a scene.
struct SceneImage {
  std::filesystem::path file;
  ScenePosition position;
};

struct SceneBuildOptions {
  /// Matching options. `disparities` is the range of the shortest edges, scaled for longer ones.
  /// With `disparities_auto` every edge has its own range.
  MatchOptions match;
  std::string settings = "{}";  ///< a JSON object: the fields of `match` that affect maps
  /// Copies the images into the folder, which then depends on nothing else.
  bool copy_images = false;
  /// Refuses edges whose rows or columns do not correspond, or of which few pixels match
  /// (edge_check.h).
  bool check_rectification = true;

  /// Throws UsageError as MatchOptions does, and for a search in two dimensions.
  void validate() const;
};

/// Matches the edges of a scene, one after the other, and stores them in a folder: scene.json, and
/// two maps and two masks of each edge in maps/. Files are written atomically, and scene.json lists
/// an edge when its maps are safe, so that building can be interrupted and continued. Edges already
/// in the folder, of the same images, positions and settings, are kept. scene.json names images
/// relative to the folder. Copies are in images/, named after the image and its content; unused
/// ones stay.
///
/// Columns are matched as rows of transposed images, oblique edges as rows of sheared ones
/// (sheared_images.h). Both maps of an edge are on the grids of its images and count pixels along
/// the edge: d ≥ 0 for usual scenes, larger is nearer.
///
/// Thread rule: one thread at a time; one process per folder, which locks it.
class SceneBuilder {
 public:
  /// Reads all images and the state of the folder, which is created if missing; removes outdated
  /// entries from scene.json. Throws Error naming the file for images that cannot be read or differ
  /// in size, depth or channels, for a damaged scene.json, while another process builds the scene,
  /// and as SceneLayout does; UsageError for invalid options. `execution` must outlive the builder.
  SceneBuilder(std::filesystem::path folder, std::vector<SceneImage> images,
               SceneBuildOptions options, Execution& execution);

  [[nodiscard]] const SceneLayout& layout() const { return layout_; }
  [[nodiscard]] const std::filesystem::path& image_file(int vertex) const {
    return images_.at(static_cast<std::size_t>(vertex)).file;
  }
  /// Indices into layout().edges() of the edges still to match.
  [[nodiscard]] const std::vector<int>& edges_to_match() const { return edges_to_match_; }

  /// Result for one edge.
  struct BuiltEdge {
    StoredEdge stored;
    /// Misalignment of its rows or columns; negative disparities indicate wrong camera positions.
    /// None unless requested, or if too few points were found.
    std::optional<VerticalError> rectification;
    double check_seconds = 0;  ///< duration of this check
  };

  /// Matches and stores an edge of the layout. Throws Error naming the images, also for those that
  /// the check refuses; nothing of such an edge is stored.
  BuiltEdge build(int edge, MatchReport* report = nullptr);

 private:
  [[nodiscard]] StoredImage stored_image(const SceneImage& image) const;
  void remove_leftovers() const;
  void keep_finished_edges();
  /// The maps of `built.stored.edge` on the grids of its images; sets the other values of `built`
  /// but the files.
  [[nodiscard]] DisparityMaps maps_of(BuiltEdge& built, MatchReport* report) const;
  /// Checks and matches images whose rows correspond.
  [[nodiscard]] DisparityMaps match(const std::array<Photograph, 2>& images, BuiltEdge& built,
                                    MatchReport* report) const;
  [[nodiscard]] MatchOptions options_for(const SceneEdge& edge, const Photograph& first,
                                         const Photograph& second) const;

  std::filesystem::path folder_;
  std::vector<SceneImage> images_;
  SceneBuildOptions options_;
  Execution& execution_;
  StoredScene scene_;
  SceneLayout layout_;
  FileLock lock_;
  std::vector<int> edges_to_match_;
};

}  // namespace vantage
