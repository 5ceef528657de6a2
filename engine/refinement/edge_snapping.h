#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Working memory of edge snapping, reused from call to call.
struct EdgeSnappingWork {
  Image<float> grey;      ///< grey levels with margins, then smoothed
  Image<float> smooth_x;  ///< grey levels smoothed along the rows
  Image<std::int16_t> gradient_x;
  Image<std::int16_t> gradient_y;
  Mask edges;
};

inline std::size_t held_bytes(const EdgeSnappingWork& work) {
  return held_bytes(work.grey) + held_bytes(work.smooth_x) + held_bytes(work.gradient_x) +
         held_bytes(work.gradient_y) + held_bytes(work.edges);
}

/// Marks the intensity edges of a photograph (255) by Canny's method: luma smoothed by a Gaussian
/// of σ = 1 (border replicated), central differences ÷ 2, thresholds of 6 and 10 grey levels per
/// pixel on the gradient's length (EQUATIONS §5.1). Resizes `work.edges` to the photograph.
/// Identical for any `execution`.
void find_edges(const Photograph& photograph, Execution& execution, EdgeSnappingWork& work);

/// Moves the discontinuities of a map to edges of its own image, row by row, by at most `max_px`
/// columns; direction as in kernels::snap_discontinuities_row(). `edges` has the size of the map.
/// Identical for any `execution`.
void snap_discontinuities(const Mask& edges, int max_px, Execution& execution,
                          DisparityMap& map_px);

}  // namespace vantage
