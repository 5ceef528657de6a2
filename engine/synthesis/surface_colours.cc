#include "engine/synthesis/surface_colours.h"

#include <cstddef>

#include "kernels/photograph_position/photograph_position.h"
#include "kernels/surface_fetch/surface_fetch.h"

namespace vantage {

template <typename T>
void SurfaceColours<T>::fetch(const kernels::SourcePositions& positions, int count,
                              float* colours) const {
  const ImageView<const float>& map = photograph.empty() ? disparity_px : photograph.disparity_px;
  if (!photograph.empty()) {
    kernels::photograph_positions_row(
        {.x_px = photograph.positions.x_px.data(),
         .y_px = photograph.positions.y_px.data(),
         .stride = static_cast<std::ptrdiff_t>(photograph.positions.x_px.stride()),
         .width = disparity_px.width(),
         .height = disparity_px.height(),
         .photograph_width = pixels.width(),
         .photograph_height = pixels.height()},
        positions, count);
  }
  kernels::fetch_surface_row(
      kernels::SurfaceFetchRow<T>{.pixels = pixels.data(),
                                  .stride = static_cast<std::ptrdiff_t>(pixels.stride()),
                                  .map_px = map.data(),
                                  .map_stride = static_cast<std::ptrdiff_t>(map.stride()),
                                  .width = pixels.width(),
                                  .height = pixels.height(),
                                  .channels = pixels.channels(),
                                  .column = positions.column,
                                  .line = positions.line,
                                  .fraction_x = positions.fraction_x,
                                  .fraction_y = positions.fraction_y,
                                  .disparity_px = positions.disparity_px,
                                  .count = count,
                                  .gradient_limit_px = gradient_limit_px},
      colours);
}

template struct SurfaceColours<std::uint8_t>;
template struct SurfaceColours<std::uint16_t>;
template struct SurfaceColours<float>;

}  // namespace vantage
