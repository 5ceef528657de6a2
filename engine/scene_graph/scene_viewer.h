#pragma once

#include <array>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/scene_graph/scene_layout.h"
#include "engine/synthesis/view_synthesizer.h"

namespace vantage {

/// The map of an image from one of its edges.
struct SceneEdgeMap {
  int neighbour = 0;          ///< vertex at the other end
  double length = 1;          ///< of the edge
  DisparityMap disparity_px;  ///< in pixels of the edge; NaN = unknown
  Mask unmatched;             ///< 255 where the disparity is a guess
};

/// What is known of a vertex.
struct SceneVertex {
  Photograph image;
  std::vector<SceneEdgeMap> maps;  ///< of all its edges, at least one; of the image's size
};

/// What views of one edge or triangle are made of. Immutable, so views of it can be rendered
/// concurrently.
struct SceneSources {
  std::vector<int> vertices;  ///< two or three
  double length = 1;          ///< that the maps count disparities for
  std::array<std::shared_ptr<const SceneVertex>, 3> loaded;
  std::array<DisparityMap, 3> disparity_px;
  std::array<IntensityFit, 4> pair_fit;  ///< of two
  TripleFit triple_fit;                  ///< of three
};

/// A view that is ready to be rendered.
struct PreparedSceneView {
  ScenePosition position;
  ScenePlace place;
  std::shared_ptr<const SceneSources> sources;
};

/// Renders new views of a scene graph (3.4): inside of a triangle from its three images, brought to
/// the view each by its own disparities and combined by barycentric weights; on an edge, or outside
/// of all, from the two images of the nearest edge.
///
/// Brightness moves with the view from photograph to photograph (γ = α); how intensities of an
/// edge's or triangle's images follow from each other is estimated once, in its middle, so that
/// nothing flickers on the way. At a vertex the view is its photograph wherever its map is known.
///
/// Thread rule: load() and prepare() one at a time; render() concurrently for different results,
/// also beside them. Results are identical for any ExecutionOptions, and whatever was rendered
/// before.
class SceneViewer {
 public:
  /// Lengths of its edge that a view may be away from the nearer image of it.
  static constexpr double kFarthestView = 16;

  /// Makes a vertex; called again for one that has not been needed for long. All images have one
  /// size, depth and number of channels.
  using LoadVertex = std::function<SceneVertex(int vertex)>;

  /// `layout` and `execution` must outlive the viewer. Of the options, gamma is not looked at.
  /// Throws UsageError for invalid options and for WarpColour::kForward.
  SceneViewer(const SceneLayout& layout, LoadVertex load_vertex, const SynthesisOptions& options,
              Execution& execution);

  /// Throws UsageError for a position that is not finite, or farther than kFarthestView away.
  void require_near(ScenePosition position) const;

  /// Has ready what prepare() needs for this position: calls LoadVertex. Throws as require_near()
  /// and what LoadVertex throws.
  void load(ScenePosition position);
  /// Finds what a view is made from, fuses its maps and fits its intensities unless the view before
  /// had the same sources. Throws as load().
  PreparedSceneView prepare(ScenePosition position);
  /// Throws Error when images do not go together.
  void render(const PreparedSceneView& prepared, SynthesizedView& view) const;

  /// prepare() and render(). Returns what the view was made from.
  ScenePlace synthesize(ScenePosition position, SynthesizedView& view);

 private:
  struct Loaded {
    int number = 0;
    std::shared_ptr<const SceneVertex> vertex;
  };
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
  std::list<Loaded> loaded_;                                // the last used first, as below
  std::list<std::shared_ptr<const SceneSources>> sources_;  // the few last ones
  std::map<std::vector<int>, std::array<IntensityFit, 4>> pair_fits_;
  std::map<std::vector<int>, TripleFit> triple_fits_;
};

}  // namespace vantage
