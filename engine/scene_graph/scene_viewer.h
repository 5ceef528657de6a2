#pragma once

#include <array>
#include <functional>
#include <list>
#include <map>
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

/// Renders new views of a scene graph (3.4): inside of a triangle from its three images, brought to
/// the view each by its own disparities and combined by barycentric weights; on an edge, or outside
/// of all, from the two images of the nearest edge.
///
/// Brightness moves with the view from photograph to photograph (γ = α); how intensities of an
/// edge's or triangle's images follow from each other is estimated once, in its middle, so that
/// nothing flickers on the way. At a vertex the view is its photograph wherever its map is known.
///
/// Thread rule: one thread at a time. Results are identical for any ExecutionOptions, and whatever
/// was rendered before.
class SceneViewer {
 public:
  /// Makes a vertex; called again for one that has not been needed for long. All images have one
  /// size, depth and number of channels.
  using LoadVertex = std::function<SceneVertex(int vertex)>;

  /// `layout` and `execution` must outlive the viewer. Of the options, gamma is not looked at.
  /// Throws UsageError for invalid options and for WarpColour::kForward.
  SceneViewer(const SceneLayout& layout, LoadVertex load_vertex, const SynthesisOptions& options,
              Execution& execution);

  /// Returns what the view was made from. Throws UsageError for a position farther than 16 of
  /// its edge's lengths away, Error when images do not go together, and what loading throws.
  ScenePlace synthesize(ScenePosition position, SynthesizedView& view);

 private:
  struct Loaded {
    int number = 0;
    SceneVertex vertex;
  };
  /// What views of one edge or triangle have in common.
  struct Sources {
    std::vector<int> vertices;
    double length = 1;  ///< that the maps count disparities for
    std::array<DisparityMap, 3> disparity_px;
  };
  const SceneVertex& vertex(int number);
  void prepare_sources(const ScenePlace& place);
  [[nodiscard]] ScenePosition at(int vertex) const;
  [[nodiscard]] ViewWarp warp_to(ScenePosition position, int vertex) const;
  [[nodiscard]] NewView pair_view(ScenePosition position, const Photograph& image) const;
  void synthesize_pair(ScenePosition position, SynthesizedView& view);
  void synthesize_triangle(const ScenePlace& place, ScenePosition position, SynthesizedView& view);

  const SceneLayout& layout_;
  LoadVertex load_vertex_;
  Execution& execution_;
  ViewSynthesizer synthesizer_;
  Sources sources_;           // of the last view
  std::list<Loaded> loaded_;  // the last used first
  std::map<std::vector<int>, std::array<IntensityFit, 4>> pair_fits_;
  std::map<std::vector<int>, TripleFit> triangle_fits_;
};

}  // namespace vantage
