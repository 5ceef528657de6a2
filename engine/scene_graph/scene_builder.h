#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/io/files/file_descriptor.h"
#include "engine/scene_graph/edge_maps.h"
#include "engine/scene_graph/scene_layout.h"
#include "engine/scene_graph/scene_rows.h"
#include "engine/scene_graph/stored_scene.h"

namespace vantage {

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
/// Posed cameras are joined by posed_edges(). Each edge is rectified on its own from their poses;
/// if rows are off nevertheless, the pose between the two cameras is corrected from points in
/// common (refine_relative_pose()). Maps are on the grids of the undistorted images and hold focal
/// length · length of the edge / depth. An edge that the check refuses is left out of the scene.
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

  [[nodiscard]] const std::vector<SceneEdge>& edges() const { return edges_; }
  /// What was found in the images.
  [[nodiscard]] const std::vector<Remark>& remarks() const { return remarks_; }
  /// Images whose rows are corrected.
  [[nodiscard]] const std::vector<CorrectedImage>& corrected_images() const { return corrected_; }
  [[nodiscard]] int images() const { return static_cast<int>(images_.size()); }
  /// Triangles of views; none for posed cameras.
  [[nodiscard]] int triangles() const {
    return layout_ ? static_cast<int>(layout_->triangles().size()) : 0;
  }
  [[nodiscard]] const std::filesystem::path& image_file(int vertex) const {
    return images_.at(static_cast<std::size_t>(vertex)).file;
  }
  /// Indices into edges() of the edges still to match.
  [[nodiscard]] const std::vector<int>& edges_to_match() const { return edges_to_match_; }

  /// Matches and stores an edge. Throws Error naming the images, also for those without poses that
  /// the check refuses; nothing of such an edge is stored.
  BuiltEdge build(int edge, MatchReport* report = nullptr);

  /// Throws Error for the first image all of whose edges were refused.
  void require_all_joined() const;

 private:
  [[nodiscard]] StoredImage stored_image(const SceneImage& image) const;
  void find_edges();
  void correct_rows();
  void keep_finished_edges();
  [[nodiscard]] bool is_same_image(const StoredScene& before, int vertex) const;
  [[nodiscard]] bool is_finished(const StoredEdge& stored, const StoredScene& before,
                                 const SceneEdge& edge) const;
  /// Adds an edge whose maps are stored.
  void add(const StoredEdge& stored);

  std::filesystem::path folder_;
  std::vector<SceneImage> images_;
  SceneBuildOptions options_;
  Execution& execution_;
  StoredScene scene_;
  std::vector<Remark> remarks_;
  std::vector<CorrectedImage> corrected_;
  std::optional<SceneLayout> layout_;  // of cameras without poses
  std::vector<SceneEdge> edges_;
  FileLock lock_;
  std::vector<int> edges_to_match_;
};

}  // namespace vantage
