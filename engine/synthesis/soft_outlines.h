#pragma once

#include <cstddef>
#include <functional>

#include "engine/execution.h"
#include "engine/image/image.h"

namespace vantage {

/// A surface of a new view that ends at or next to a pixel (x, y).
struct SurfaceEdge {
  int surface_x = 0;  ///< a pixel of the view that shows the surface
  int surface_y = 0;
  int x = 0;
  int y = 0;
  float nearness = 0;             ///< q of the surface
  float background_nearness = 0;  ///< of the surface behind it
};

/// Fraction of its pixel (x, y) that a surface covers, 0..1; NaN = unknown. Called concurrently.
using EdgeCoverage = std::function<double(const SurfaceEdge&)>;

/// Mixes the colours of both sides where surfaces of a view meet, by the fractions of the pixels
/// that they cover; a warp gives every pixel the colour of one surface. A pixel that is nearer than
/// some of its four neighbours takes the uncovered fraction of its own surface from them, in equal
/// parts. A pixel with nearer neighbours then takes their covered fraction: the largest of their
/// coverages, split in proportion to each one's coverage. Unknown coverage changes nothing.
///
/// `nearness`: of the image's size, NaN = hole without colour; `gradient_limit_px`: neighbours that
/// differ by more are different surfaces. Integers are rounded half up. Uses outline_bytes() of
/// scratch memory. Identical for any execution. T is uint8_t, uint16_t or float.
template <typename T>
void soften_outlines(const EdgeCoverage& coverage, ImageView<const float> nearness,
                     float gradient_limit_px, ImageView<T> image, Execution& execution);

[[nodiscard]] std::size_t outline_bytes(int width, int height, int channels,
                                        std::size_t value_bytes);

}  // namespace vantage
