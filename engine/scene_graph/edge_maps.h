#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "engine/image/photograph_reading.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/search/match_report.h"
#include "engine/rectification/rows/row_correction.h"
#include "engine/rectification/vertical_error.h"
#include "engine/scene_graph/scene_layout.h"
#include "engine/scene_graph/stored_scene.h"

namespace vantage {

/// An input image of a scene.
struct SceneImage {
  std::filesystem::path file;
  ScenePosition position;
  std::optional<SceneCamera> camera = std::nullopt;  ///< of all images of a scene, or of none
  ImageSize camera_size = {};                        ///< that the camera is for; 0×0: unknown
};

struct SceneBuildOptions {
  /// Matching options. `disparities` is the range of the shortest edges, scaled for longer ones.
  /// With `disparities_auto` every edge has its own range.
  MatchOptions match;
  std::string settings = "{}";  ///< a JSON object: the fields of `match` that affect maps
  /// Copies the images into the folder, which then depends on nothing else.
  bool copy_images = false;
  /// Refuses edges whose rows or columns do not correspond, or of which few pixels match
  /// (rectified_edge.h).
  bool check_rectification = true;
  /// With the check and without poses, images are corrected, see correct_scene_rows().
  RowMode rows = RowMode::kAuto;
  /// Neighbours that every posed camera is joined to, 1 to kMaxNeighbours.
  int neighbours = 4;
  std::optional<double> white_level = {};  ///< of all images, see WhiteLevelSearch
  PhotographReading reading = {};

  /// Throws UsageError as MatchOptions does, and for a search in two dimensions.
  void validate() const;
};

/// Result for one edge.
struct BuiltEdge {
  StoredEdge stored;
  /// Misalignment of its rows or columns; negative disparities indicate wrong camera positions.
  /// None unless requested, or if too few points were found.
  std::optional<VerticalError> rectification;
  double check_seconds = 0;  ///< duration of this check
  /// Why an edge between posed cameras is left out; empty if it was stored.
  std::string refusal;
};

/// Matches the edges of a scene. All that it is made from must outlive it. Thread rule: one thread
/// at a time.
class EdgeMaps {
 public:
  EdgeMaps(const SceneBuildOptions& options, const std::vector<SceneImage>& images,
           const StoredScene& scene, Execution& execution)
      : options_(options), images_(images), scene_(scene), execution_(execution) {}

  /// Reads the images of an edge. Throws Error.
  [[nodiscard]] std::array<Photograph, 2> photographs_of(const SceneEdge& edge) const;
  /// The maps of `built.stored.edge` on the grids of its images; sets the other values of `built`
  /// but the files. Throws Error where the check refuses the edge.
  [[nodiscard]] DisparityMaps match(std::array<Photograph, 2> images, BuiltEdge& built,
                                    MatchReport* report) const;

 private:
  [[nodiscard]] DisparityMaps maps_on_layout(std::array<Photograph, 2>& images, BuiltEdge& built,
                                             MatchReport* report) const;
  [[nodiscard]] DisparityMaps maps_of_posed(const std::array<Photograph, 2>& photographs,
                                            BuiltEdge& built, MatchReport* report) const;
  /// Matches images whose rows correspond; `scale`: factor of the given disparities.
  [[nodiscard]] DisparityMaps match_rows(const std::array<Photograph, 2>& images, double scale,
                                         BuiltEdge& built, MatchReport* report) const;
  [[nodiscard]] MatchOptions options_for(double scale, const Photograph& first,
                                         const Photograph& second) const;

  const SceneBuildOptions& options_;
  const std::vector<SceneImage>& images_;
  const StoredScene& scene_;
  Execution& execution_;
};

}  // namespace vantage
