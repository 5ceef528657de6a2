#include <algorithm>
#include <cmath>

#include "kernels/surface_fit/surface_fit.h"

namespace vantage::kernels {
namespace {

/// Disparity at lattice position (u, v), in units of the arm length: the pixel's own + height +
/// slope_u · u + slope_v · v.
struct Plane {
  float height = 0;
  float slope_u = 0;
  float slope_v = 0;
};

/// Weight of a sample, and weight times its distance from the plane.
struct FitSample {
  float w = 0;
  float we = 0;
};

FitSample weigh(float disparity_px, float plane_px) {
  constexpr float kPerReach = 1 / (kSurfaceReachPx * kSurfaceReachPx);
  const float e = disparity_px - plane_px;
  const float w = std::max(1 - e * e * kPerReach, 0.0F);
  return {w, w * e};
}

struct Sums {
  float w = 0, wu = 0, wv = 0, wuu = 0, wuv = 0, wvv = 0;
  float we = 0, weu = 0, wev = 0;
};

Sums sum_samples(const SurfaceRow& row, int x, const SurfaceLattice& lattice, const Plane& plane) {
  const float* own = row.disparity_px + x;
  const int steps = lattice.steps;
  const auto sample = [&](int i, int j) {
    return own[lattice.row(i, j) * row.pitch + lattice.column(i, j)];
  };
  Sums sums;
  for (int j = -steps; j <= steps; ++j) {
    const float v = static_cast<float>(j) / static_cast<float>(steps);
    const float middle_px = *own + (plane.height + plane.slope_v * v);
    const FitSample middle = weigh(sample(0, j), middle_px);
    Sums line;
    line.w = middle.w;
    line.we = middle.we;
    // Processes samples on both sides together, which halves the number of products.
    for (int i = 1; i <= steps; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(steps);
      const float rise_px = plane.slope_u * u;
      const FitSample above = weigh(sample(i, j), middle_px + rise_px);
      const FitSample below = weigh(sample(-i, j), middle_px - rise_px);
      const float w = above.w + below.w;
      line.w += w;
      line.wu += (above.w - below.w) * u;
      line.wuu += w * (u * u);
      line.we += above.we + below.we;
      line.weu += (above.we - below.we) * u;
    }
    const float wv = line.w * v;
    sums.w += line.w;
    sums.wu += line.wu;
    sums.wv += wv;
    sums.wuu += line.wuu;
    sums.wuv += line.wu * v;
    sums.wvv += wv * v;
    sums.we += line.we;
    sums.weu += line.weu;
    sums.wev += line.we * v;
  }
  return sums;
}

/// Moves `plane` to the best fit, given the sums of distances from it.
void improve(const Sums& sums, Plane& plane) {
  const float w = sums.w + kMinSurfaceWeight;
  const float n = 1 / w;
  const float u = sums.wu * n;
  const float v = sums.wv * n;
  const float ridge = w * kSlopeRidge;
  const float uu = (sums.wuu - sums.wu * u) + ridge;
  const float vv = (sums.wvv - sums.wv * v) + ridge;
  const float uv = sums.wuv - sums.wu * v;
  const float eu = sums.weu - sums.we * u;
  const float ev = sums.wev - sums.we * v;
  const float determinant = uu * vv - uv * uv;
  const float slope_u = (eu * vv - ev * uv) / determinant;
  const float slope_v = (ev * uu - eu * uv) / determinant;
  plane.height += (sums.we * n - slope_u * u) - slope_v * v;
  plane.slope_u += slope_u;
  plane.slope_v += slope_v;
}

}  // namespace

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
    Plane plane;
    for (int pass = 0; pass < kSurfacePasses; ++pass) {
      improve(sum_samples(row, x, lattice, plane), plane);
    }
    if (std::abs(plane.height) < kSurfaceReachPx) {
      fitted_px[x] = std::clamp(row.disparity_px[x] + plane.height, row.min_px, row.max_px);
    }
  }
}

}  // namespace vantage::kernels
