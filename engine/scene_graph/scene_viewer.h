#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/scene_graph/fused_map.h"
#include "engine/scene_graph/recently_used.h"
#include "engine/scene_graph/scene_layout.h"
#include "engine/synthesis/view_synthesizer.h"

namespace vantage {

/// The map of an image from one of its edges.
struct SceneEdgeMap {
  int neighbour = 0;          ///< vertex at the other end
  double length = 1;          ///< of the edge
  DisparityMap disparity_px;  ///< in pixels of the edge; NaN = unknown
  Mask unmatched;             ///< 255 where the disparity is estimated by filling
};

/// Data of a vertex.
struct SceneVertex {
  Photograph image;
  std::vector<SceneEdgeMap> maps;  ///< of all its edges, at least one; of the image's size
};

/// Its maps for fuse_maps(), all of own edges. They refer to it.
std::vector<MapOfEdge> maps_of(const SceneVertex& vertex);

/// Sources of the views of one edge or triangle. Immutable, so views can be rendered concurrently.
struct SceneSources {
  std::vector<int> vertices;  ///< two or three
  double length = 1;          ///< baseline of the maps' disparities
  std::array<std::shared_ptr<const SceneVertex>, 3> loaded;
  std::array<DisparityMap, 3> disparity_px;
  std::array<IntensityFit, 4> pair_fit;  ///< of two
  TripleFit triple_fit;                  ///< of three
};

/// A view ready for rendering.
struct PreparedSceneView {
  ScenePosition position;
  ScenePlace place;
  std::shared_ptr<const SceneSources> sources;
};

/// `options` for views of a scene: brightness moves from image to image. Throws UsageError if they
/// warp forward. Thread rule: pure.
SynthesisOptions with_moving_brightness(SynthesisOptions options);

/// Renders new views of a scene graph (3.4): inside a triangle from its three images, each warped
/// to the view by its own disparities and combined by barycentric weights; on an edge, or outside
/// of all, from the two images of the nearest edge.
///
/// Brightness changes continuously from photograph to photograph (γ = α); intensity regressions of
/// an edge or triangle are estimated once, at its centre, to avoid flicker. At a vertex the view is
/// its photograph wherever its map is known.
///
/// Thread rule: load() and prepare() one at a time; render() concurrently for different results,
/// also with them. Results are identical for any ExecutionOptions, and independent of earlier
/// views.
class SceneViewer {
 public:
  /// Makes a vertex; called again for one that was evicted. All images have one size, depth and
  /// number of channels.
  using LoadVertex = std::function<SceneVertex(int vertex)>;

  /// `layout` and `execution` must outlive the viewer. `options.gamma` is ignored. Throws
  /// UsageError for invalid options and for WarpColour::kForward.
  SceneViewer(const SceneLayout& layout, LoadVertex load_vertex, const SynthesisOptions& options,
              Execution& execution);

  /// Throws UsageError for a position that is not finite, or farther than kMaxViewDistance away.
  void require_near(ScenePosition position) const;

  /// Prepares the vertices that prepare() needs for this position: calls LoadVertex. Throws as
  /// require_near() and LoadVertex.
  void load(ScenePosition position);
  /// Finds the sources of a view, fuses their maps and fits their intensities unless the previous
  /// view had the same sources. Throws as load().
  PreparedSceneView prepare(ScenePosition position);
  /// Throws Error when images do not match.
  void render(const PreparedSceneView& prepared, SynthesizedView& view) const;

  /// prepare() and render(). Returns the sources of the view.
  ScenePlace synthesize(ScenePosition position, SynthesizedView& view);

 private:
  [[nodiscard]] ScenePosition at(int vertex) const;
  [[nodiscard]] double length_of(const ScenePlace& place) const;
  const std::shared_ptr<const SceneVertex>& vertex(int number);
  [[nodiscard]] std::shared_ptr<const SceneSources> make_sources(const ScenePlace& place);
  void fit_intensities(SceneSources& sources);
  [[nodiscard]] ViewWarp warp_to(ScenePosition position, int vertex, double length) const;
  [[nodiscard]] NewView pair_view(const SceneSources& sources, ScenePosition position) const;
  [[nodiscard]] TripleView triple_view(const SceneSources& sources, ScenePosition position) const;

  const SceneLayout& layout_;
  LoadVertex load_vertex_;
  Execution& execution_;
  ViewSynthesizer synthesizer_;
  // In addition to those of views in progress; a stereo view needs up to six vertices.
  RecentlyUsed<int, std::shared_ptr<const SceneVertex>> loaded_{8};
  RecentlyUsed<std::vector<int>, std::shared_ptr<const SceneSources>> sources_{2};
  std::map<std::vector<int>, std::array<IntensityFit, 4>> pair_fits_;
  std::map<std::vector<int>, TripleFit> triple_fits_;
};

}  // namespace vantage
