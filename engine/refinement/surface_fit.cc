#include "engine/refinement/surface_fit.h"

#include <algorithm>

#include "kernels/surface_fit/surface_fit.h"

namespace vantage {

void fit_surface(const Mask& unmatched, int radius_px, DisparityRange search, Execution& execution,
                 SurfaceFitWork& work, DisparityMap& map_px) {
  const int width = map_px.width();
  const int height = map_px.height();
  work.matched_px.resize(radius_px + width + radius_px + kernels::kSurfaceRowSlack,
                         radius_px + height + radius_px);
  execution.for_each_band(work.matched_px.height(), [&](int first_row, int end_row) {
    for (int row = first_row; row < end_row; ++row) {
      float* values = work.matched_px.row(row);
      std::fill_n(values, work.matched_px.width(), kernels::kNoSurfacePx);
      const int y = row - radius_px;
      if (y < 0 || y >= height) {
        continue;
      }
      const std::uint8_t* is_unmatched = unmatched.row(y);
      const float* map = map_px.row(y);
      for (int x = 0; x < width; ++x) {
        values[radius_px + x] = is_unmatched[x] != 0 ? kernels::kNoSurfacePx : map[x];
      }
    }
  });
  execution.for_each_band(height, [&](int first_row, int end_row) {
    for (int y = first_row; y < end_row; ++y) {
      kernels::fit_surface_row(
          {.disparity_px = work.matched_px.row(y + radius_px) + radius_px,
           .pitch = static_cast<std::ptrdiff_t>(work.matched_px.view().stride()),
           .radius_px = radius_px,
           .width = width,
           .min_px = static_cast<float>(search.min),
           .max_px = static_cast<float>(search.max)},
          map_px.row(y));
    }
  });
}

}  // namespace vantage
