#pragma once

#include <algorithm>
#include <cstddef>

#include "kernels/surface_fit/surface_fit.h"

namespace vantage::kernels {

// One plane by one, for the scalar references; surface_plane-inl.h is the vector form.

/// Disparity at lattice position (u, v), in units of the arm length: the centre's own + height +
/// slope_u · u + slope_v · v.
struct SurfacePlane {
  float height = 0;
  float slope_u = 0;
  float slope_v = 0;
};

/// Weight of a sample, and weight times its distance from the plane.
struct SurfaceSample {
  float w = 0;
  float we = 0;
};

/// `falloff`: weight of a sample on the plane.
inline SurfaceSample weigh_surface_sample(float disparity_px, float plane_px, float falloff) {
  constexpr float kPerReach = 1 / (kSurfaceReachPx * kSurfaceReachPx);
  const float e = disparity_px - plane_px;
  const float w = std::max(falloff - e * e * (falloff * kPerReach), 0.0F);
  return {w, w * e};
}

struct SurfaceSums {
  float w = 0, wu = 0, wv = 0, wuu = 0, wuv = 0, wvv = 0;
  float we = 0, weu = 0, wev = 0;
};

/// `centre`: disparity at the lattice's centre.
inline SurfaceSums sum_surface_samples(const float* centre, std::ptrdiff_t pitch,
                                       const SurfaceLattice& lattice, const SurfacePlane& plane) {
  const int steps = lattice.steps;
  const auto sample = [&](int i, int j, float plane_px) {
    return weigh_surface_sample(centre[lattice.row(i, j) * pitch + lattice.column(i, j)], plane_px,
                                lattice.falloff_at(i, j));
  };
  SurfaceSums sums;
  for (int j = -steps; j <= steps; ++j) {
    const float v = static_cast<float>(j) / static_cast<float>(steps);
    const float middle_px = *centre + (plane.height + plane.slope_v * v);
    const SurfaceSample middle = sample(0, j, middle_px);
    SurfaceSums line;
    line.w = middle.w;
    line.we = middle.we;
    // Processes samples on both sides together, which halves the number of products.
    for (int i = 1; i <= steps; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(steps);
      const float rise_px = plane.slope_u * u;
      const SurfaceSample above = sample(i, j, middle_px + rise_px);
      const SurfaceSample below = sample(-i, j, middle_px - rise_px);
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
inline void improve_surface_plane(const SurfaceSums& sums, SurfacePlane& plane) {
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

/// The plane at a lattice's centre.
inline SurfacePlane fit_surface_plane(const float* centre, std::ptrdiff_t pitch,
                                      const SurfaceLattice& lattice) {
  SurfacePlane plane;
  for (int pass = 0; pass < kSurfacePasses; ++pass) {
    improve_surface_plane(sum_surface_samples(centre, pitch, lattice, plane), plane);
  }
  return plane;
}

}  // namespace vantage::kernels
