#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/scene_graph/recently_used.h"
#include "engine/scene_graph/scene_camera.h"
#include "engine/scene_graph/scene_viewer.h"
#include "engine/scene_graph/stored_scene.h"
#include "engine/synthesis/blended_warper.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/view_geometry/posed_camera.h"

namespace vantage {

inline constexpr int kMaxViewSources = 16;

/// An image of a posed scene, undistorted, with one map fused from all its edges.
struct PosedVertex {
  Photograph image;
  DisparityMap disparity_px;  ///< PosedViewer::scale_px() / depth
};

/// A view ready for rendering.
struct PreparedPosedView {
  struct Source {
    int vertex = 0;
    double share = 1;  ///< see BlendSource
    std::shared_ptr<const PosedVertex> loaded;
    std::array<IntensityFit, 4> on_first;
  };
  PosedCamera camera;
  std::vector<Source> sources;
};

/// Renders views of a scene of posed cameras (3.4) from any pose near them: blended from the
/// cameras that are nearest to it (BlendedWarper). Distance counts the turn, too: the distance of
/// the centres plus that by which the images move apart at a typical depth. Shares fall to 0
/// towards the first camera that is left out, so that views change continuously along a path.
///
/// Thread rule: as SceneViewer. Results are identical for any ExecutionOptions, and independent of
/// earlier views.
class PosedViewer {
 public:
  using LoadVertex = std::function<SceneVertex(int vertex)>;

  /// `scene` is posed and complete. `sources`: 1 to kMaxViewSources photographs of a view; as many
  /// as there are if fewer. `options.gamma` is ignored. Throws UsageError for invalid options, and
  /// for WarpColour::kForward.
  PosedViewer(const StoredScene& scene, LoadVertex load_vertex, const SynthesisOptions& options,
              int sources, Execution& execution);

  /// The camera of an image, without its distortion, in the world.
  [[nodiscard]] PosedCamera camera_of(int vertex) const;
  /// Median length of the edges, in the unit of the world.
  [[nodiscard]] double unit_length() const { return unit_length_; }

  /// Throws Error for an invalid camera, and UsageError for one that is farther than
  /// kMaxViewDistance median edges from all images, or that looks away from them by more
  /// than 60 degrees.
  void require_near(const PosedCamera& camera) const;

  /// As SceneViewer has them.
  void load(const PosedCamera& camera);
  PreparedPosedView prepare(const PosedCamera& camera);
  void render(const PreparedPosedView& prepared, SynthesizedView& view) const;

 private:
  [[nodiscard]] std::vector<std::pair<int, double>> sources_of(const PosedCamera& camera) const;
  [[nodiscard]] ViewWarp warp_from(int vertex, const PosedCamera& camera) const;
  std::shared_ptr<const PosedVertex> vertex(int number);
  std::shared_ptr<const PosedVertex> make_vertex(int number);
  const std::array<IntensityFit, 4>& fit(const PreparedPosedView::Source& first,
                                         const PreparedPosedView::Source& other);

  std::vector<SceneCamera> cameras_;
  int width_px_;
  int height_px_;
  double unit_length_;
  double scale_px_;
  double typical_depth_;
  LoadVertex load_vertex_;
  int sources_;
  Execution& execution_;
  ViewSynthesizer synthesizer_;  // for regressions
  BlendedSynthesizer blended_;
  RecentlyUsed<int, std::shared_ptr<const PosedVertex>> loaded_{std::size_t{4} * kMaxViewSources};
  std::map<std::pair<int, int>, std::array<IntensityFit, 4>> fits_;
};

}  // namespace vantage
