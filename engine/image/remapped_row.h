#pragma once

#include <cstddef>

#include "engine/image/image.h"
#include "kernels/bicubic_remap/bicubic_remap.h"

namespace vantage {

/// Row `y` of `result` is read from `source` at the positions `x_px`, `y_px` of its pixels, in
/// bicubic interpolation; 0 more than half a pixel outside and where a position is NaN.
template <typename T>
void remap_row(const Image<T>& source, const float* x_px, const float* y_px, int y,
               Image<T>& result) {
  kernels::remap_bicubic_row(
      kernels::RemapRow<T>{.pixels = source.row(0),
                           .stride = static_cast<std::ptrdiff_t>(source.view().stride()),
                           .width = source.width(),
                           .height = source.height(),
                           .channels = source.channels(),
                           .x_px = x_px,
                           .y_px = y_px,
                           .count = result.width()},
      result.row(y));
}

}  // namespace vantage
