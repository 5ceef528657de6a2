#pragma once

#include <cstddef>
#include <functional>

#include "engine/execution.h"
#include "engine/image/image.h"

namespace vantage {

/// A surface of a new view that ends beside, or at, a pixel (x, y).
struct SurfaceEdge {
  int surface_x = 0;  ///< a pixel of the view that shows the surface
  int surface_y = 0;
  int x = 0;
  int y = 0;
  float nearness = 0;             ///< q of the surface
  float background_nearness = 0;  ///< of what lies behind it
};

/// How much of its pixel (x, y) a surface covers, 0..1; NaN = not known. Called concurrently.
using EdgeCoverage = std::function<double(const SurfaceEdge&)>;

/// Mixes the colours of both sides where surfaces of a view meet, in the shares in which they cover
/// its pixels: a warp gives every pixel the colour of one surface. A pixel that is nearer than some
/// of its four neighbours takes from them, in equal parts, what its own surface leaves free. One
/// that has nearer neighbours then takes from these what they cover: as much as the surface that
/// covers most, in parts as each of them covers. What is not known stays as it is.
///
/// `nearness`: of the image's size, NaN = hole that has no colour; `gradient_limit_px`: neighbours
/// that differ by more are different surfaces. Integers are rounded half up. Works in
/// outline_bytes() of scratch memory. Identical for any execution. T is uint8_t, uint16_t or float.
template <typename T>
void soften_outlines(const EdgeCoverage& coverage, ImageView<const float> nearness,
                     float gradient_limit_px, ImageView<T> image, Execution& execution);

[[nodiscard]] std::size_t outline_bytes(int width, int height, int channels,
                                        std::size_t value_bytes);

}  // namespace vantage
