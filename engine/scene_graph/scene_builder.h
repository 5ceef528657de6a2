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

/// An image that a scene is built from.
struct SceneImage {
  std::filesystem::path file;
  ScenePosition position;
};

struct SceneBuildOptions {
  /// How edges are matched. `disparities` is the range of the shortest edges; that of longer ones
  /// is as much wider. With `disparities_auto` every edge has its own.
  MatchOptions match;
  std::string settings = "{}";  ///< a JSON object: what of `match` decides the maps
  /// Whether images are copied into the folder, which then depends on nothing else.
  bool copy_images = false;
  bool check_rectification = true;  ///< whether to look if rows and columns correspond

  /// Throws UsageError as MatchOptions does, and for a search in two dimensions.
  void validate() const;
};

/// Matches the edges of a scene and stores them, one after the other, in a folder:
/// scene.json, and two maps and two masks of each edge in maps/. Every file is whole or not there
/// at all, and scene.json tells of an edge when its maps are safe, so that building can be stopped
/// and continued. Edges that the folder has already, of the same images, places and settings, are
/// kept. scene.json names images as seen from the folder. Copies are in images/, with names made of
/// the image's own and its content; those that are no longer of use stay.
///
/// Columns are matched as rows of transposed images, oblique edges as rows of sheared ones
/// (sheared_images.h). Both maps of an edge are on the grids of its images and count pixels along
/// the edge: d ≥ 0 for the usual scene, near is large.
///
/// Thread rule: one thread at a time; one process per folder, which locks it.
class SceneBuilder {
 public:
  /// Reads all images and what the folder holds, which is made if it is missing; removes from
  /// scene.json what does not hold any more. Throws Error naming the file for images that cannot be
  /// read or differ in size, depth or channels, for a damaged scene.json, while another process
  /// builds the scene, and as SceneLayout does;
  /// UsageError for invalid options. `execution` must outlive the builder.
  SceneBuilder(std::filesystem::path folder, std::vector<SceneImage> images,
               SceneBuildOptions options, Execution& execution);

  [[nodiscard]] const SceneLayout& layout() const { return layout_; }
  [[nodiscard]] const std::filesystem::path& image_file(int vertex) const {
    return images_.at(static_cast<std::size_t>(vertex)).file;
  }
  /// Those of layout().edges() that have to be matched, by number.
  [[nodiscard]] const std::vector<int>& edges_to_match() const { return edges_to_match_; }

  /// What an edge has become.
  struct BuiltEdge {
    StoredEdge stored;
    /// How far its rows, or columns, are from corresponding; disparities that are below 0 tell that
    /// images are not where they are said to be. None unless wanted, and where too few points were
    /// found.
    std::optional<VerticalError> rectification;
    double check_seconds = 0;  ///< that finding this out took
  };

  /// Matches and stores an edge of the layout. Throws Error naming the images.
  BuiltEdge build(int edge, MatchReport* report = nullptr);

 private:
  [[nodiscard]] StoredImage stored_image(const SceneImage& image) const;
  void remove_leftovers() const;
  void keep_finished_edges();
  void match(const SceneEdge& edge, const std::array<Photograph, 2>& images, DisparityMaps& maps,
             StoredEdge& result, MatchReport* report) const;
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
