#pragma once

#include <cstdint>

#include "engine/execution.h"
#include "engine/image/image.h"

namespace vantage {

/// Limits of the length of a gradient, ≥ 0. A pixel above `high` is an edge; one above `low` is an
/// edge if it is connected to such a pixel.
struct EdgeThresholds {
  int low = 0;
  int high = 0;
};

/// Canny's edges (255, else 0) of an image with these gradients, of ±32767: pixels whose gradient
/// is longest along its direction, of four, and longer than `high`, or longer than `low` and
/// connected to such pixels by others. Along a direction the first of equal neighbours counts as
/// the longest; the gradient is 0 outside the image. As cv::Canny() of gradients does it. `edges`
/// has the size of the gradients. Identical for any `execution`. Thread rule: may be called
/// concurrently for different results.
void trace_edges(const Image<std::int16_t>& gradient_x, const Image<std::int16_t>& gradient_y,
                 EdgeThresholds thresholds, Execution& execution, Mask& edges);

}  // namespace vantage
