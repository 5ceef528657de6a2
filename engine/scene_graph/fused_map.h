#pragma once

#include <span>

#include "engine/execution.h"
#include "engine/image/image.h"

namespace vantage {

/// A disparity map of an image from one of its edges.
struct MapOfEdge {
  ImageView<const float> disparity_px;         ///< in pixels of that edge
  ImageView<const std::uint8_t> is_unmatched;  ///< 255 where the disparity is estimated by filling
  double edge_length = 1;
  bool is_own = true;  ///< the edge belongs to what the view is made from
};

/// Fuses the maps of an image from all its edges (at least one, all of one size) to one for a
/// baseline of `length`. A pixel gets the first of these that exists:
/// - matched disparities of own edges: the mean of the largest group that agrees within
/// `tolerance_px` around one of them, ties going to the farthest group;
/// - matched disparities of the other edges: what is hidden from one neighbour is often visible to
/// another;
/// - the farthest filled disparity of own edges, because the pixel is hidden from the neighbours;
/// of other edges; NaN.
/// Own edges go first because a pair's own maps fit its images best. `fused_px` has the same size.
/// Identical for any execution. Thread rule: pure.
void fuse_maps(std::span<const MapOfEdge> maps, double length, double tolerance_px,
               ImageView<float> fused_px, Execution& execution);

}  // namespace vantage
