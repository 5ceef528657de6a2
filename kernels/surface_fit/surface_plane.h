#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "kernels/surface_fit/surface_fit.h"

namespace vantage::kernels {

// One plane by one, for the scalar references; surface_plane-inl.h is the vector form. Everything
// is in steps of the format (SurfaceFormat). Sums are integers, so their order does not matter;
// equations are solved in floats. The first plane is rounded, so that distances from it are
// integers: that only moves the point from which the second pass starts.

/// Stored disparity i, j steps along the lattice's arms: the centre's own + height + slope_u · i +
/// slope_v · j.
template <typename T>
struct SurfacePlane {
  T height = 0;
  T slope_u = 0;
  T slope_v = 0;
};

/// Sums over samples of weights w, and of weights times e, the plane's height above the sample.
struct SurfaceSums {
  int w = 0, wu = 0, wv = 0, wuu = 0, wuv = 0, wvv = 0;
  int we = 0, weu = 0, wev = 0;
};

/// `centre`: the lattice's, matched.
inline SurfaceSums sum_surface_samples(const std::int16_t* centre, std::ptrdiff_t pitch,
                                       const SurfaceLattice& lattice, const SurfaceWeights& weights,
                                       const SurfacePlane<int>& plane) {
  SurfaceSums sums;
  for (int j = -lattice.steps; j <= lattice.steps; ++j) {
    for (int i = -lattice.steps; i <= lattice.steps; ++i) {
      const int sample = centre[lattice.row(i, j) * pitch + lattice.column(i, j)];
      const int e = (*centre + plane.height + plane.slope_u * i + plane.slope_v * j) - sample;
      const int share = weights.share[static_cast<std::size_t>(i * i + j * j)];
      const int w = (std::max(weights.reach - std::abs(e), 0) * share) >> 16;
      sums.w += w;
      sums.wu += w * i;
      sums.wv += w * j;
      sums.wuu += w * i * i;
      sums.wuv += w * i * j;
      sums.wvv += w * j * j;
      sums.we += w * e;
      sums.weu += w * e * i;
      sums.wev += w * e * j;
    }
  }
  return sums;
}

/// Ridge of squared slopes per step.
inline float surface_ridge(const SurfaceLattice& lattice) {
  return kSlopeRidge * static_cast<float>(lattice.steps * lattice.steps);
}

/// What the plane that heights were measured from is above the best fit.
inline SurfacePlane<float> surface_correction(const SurfaceSums& sums, float ridge) {
  const auto wu = static_cast<float>(sums.wu);
  const auto wv = static_cast<float>(sums.wv);
  const auto we = static_cast<float>(sums.we);
  // Without samples, all sums are 0.
  const float w = std::max(static_cast<float>(sums.w), 1.0F);
  const float ridge_ww = w * w * ridge;
  const float uu = (static_cast<float>(sums.wuu) * w - wu * wu) + ridge_ww;
  const float vv = (static_cast<float>(sums.wvv) * w - wv * wv) + ridge_ww;
  const float uv = static_cast<float>(sums.wuv) * w - wu * wv;
  const float eu = static_cast<float>(sums.weu) * w - we * wu;
  const float ev = static_cast<float>(sums.wev) * w - we * wv;
  const float determinant = uu * vv - uv * uv;
  const float inverse = 1 / (determinant * w);  // of both in one division
  const float per_determinant = inverse * w;
  const float per_w = inverse * determinant;
  const float slope_u = (eu * vv - ev * uv) * per_determinant;
  const float slope_v = (ev * uu - eu * uv) * per_determinant;
  return {((we - slope_u * wu) - slope_v * wv) * per_w, slope_u, slope_v};
}

/// The plane at a lattice's centre.
inline SurfacePlane<float> fit_surface_plane(const std::int16_t* centre, std::ptrdiff_t pitch,
                                             const SurfaceLattice& lattice,
                                             const SurfaceFormat& format) {
  const SurfaceWeights weights = surface_weights(lattice, format);
  const float ridge = surface_ridge(lattice);
  const SurfacePlane<float> first =
      surface_correction(sum_surface_samples(centre, pitch, lattice, weights, {}), ridge);
  const auto rounded = [&](float value) {
    const int limit = kMaxFirstSurfacePx << format.fraction_bits;
    return std::clamp(-static_cast<int>(std::nearbyint(value)), -limit, limit);
  };
  const SurfacePlane<int> plane = {rounded(first.height), rounded(first.slope_u),
                                   rounded(first.slope_v)};
  const SurfacePlane<float> last =
      surface_correction(sum_surface_samples(centre, pitch, lattice, weights, plane), ridge);
  return {static_cast<float>(plane.height) - last.height,
          static_cast<float>(plane.slope_u) - last.slope_u,
          static_cast<float>(plane.slope_v) - last.slope_v};
}

/// A disparity as it is stored, halves to even.
inline std::int16_t surface_sample(float disparity_px, const SurfaceFormat& format) {
  const auto limit = static_cast<float>(max_surface_sample(format));
  const float units = (disparity_px - format.middle_px) * format.units_per_px();
  return static_cast<std::int16_t>(std::nearbyint(std::clamp(units, -limit, limit)));
}

}  // namespace vantage::kernels
