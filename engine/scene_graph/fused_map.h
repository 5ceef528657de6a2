#pragma once

#include <span>

#include "engine/execution.h"
#include "engine/image/image.h"

namespace vantage {

/// A disparity map of an image from one of its edges.
struct MapOfEdge {
  ImageView<const float> disparity_px;         ///< in pixels of that edge
  ImageView<const std::uint8_t> is_unmatched;  ///< 255 where the disparity is a guess
  double edge_length = 1;
  bool is_own = true;  ///< the edge belongs to what the view is made from
};

/// One map of an image, for a baseline of `length`, from those of all its edges, at least one, all
/// of one size. A pixel has the first of these that there is:
/// - the disparities that own edges matched: the mean of those that agree within `tolerance_px`, of
///   the largest group that does around one of them, of equal ones the farthest;
/// - the same of the other edges: what one neighbour does not see of an image another one often
///   does;
/// - the farthest guess of own edges: it is hidden from the neighbours; of others; NaN.
/// Own edges go first because a pair's own maps fit its images best. `fused_px` is of the same
/// size. Identical for any execution.
void fuse_maps(std::span<const MapOfEdge> maps, double length, double tolerance_px,
               ImageView<float> fused_px, Execution& execution);

}  // namespace vantage
