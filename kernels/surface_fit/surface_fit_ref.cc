#include <algorithm>
#include <cmath>

#include "kernels/surface_fit/surface_fit.h"
#include "kernels/surface_fit/surface_plane.h"

namespace vantage::kernels {

SurfaceLattice surface_lattice(int radius_px) {
  if (radius_px < kMaxSurfaceSteps) {
    return {};
  }
  // Arms of two steps reach 2 · (step_x + step_y) columns and rows. At a ratio near 3 : 2 they are
  // about equally far from the rows and from the diagonals.
  const int both = radius_px / kMaxSurfaceSteps;
  const int step_y = radius_px / 5;
  return {.steps = kMaxSurfaceSteps, .step_x = both - step_y, .step_y = step_y};
}

void fit_surface_row_ref(const SurfaceRow& row, float* fitted_px) {
  const SurfaceLattice lattice = surface_lattice(row.radius_px);
  for (int x = 0; x < row.width; ++x) {
    if (row.disparity_px[x] == kNoSurfacePx) {
      continue;
    }
    const SurfacePlane plane = fit_surface_plane(row.disparity_px + x, row.pitch, lattice);
    if (std::abs(plane.height) < kSurfaceReachPx) {
      fitted_px[x] = std::clamp(row.disparity_px[x] + plane.height, row.min_px, row.max_px);
    }
  }
}

}  // namespace vantage::kernels
