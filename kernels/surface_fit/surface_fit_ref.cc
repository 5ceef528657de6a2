#include <algorithm>
#include <cmath>

#include "kernels/surface_fit/surface_fit.h"
#include "kernels/surface_fit/surface_plane.h"

namespace vantage::kernels {

SurfaceFormat surface_format(int min_px, int max_px) {
  constexpr int kMinFractionBits = 3;  // with less, weights have no steps left
  SurfaceFormat format;
  format.middle_px = 0.5F * static_cast<float>(min_px + max_px);
  const auto fits = [&] {
    const float reach_px = 0.5F * static_cast<float>(max_px - min_px) + kSurfaceRangeMarginPx;
    return reach_px * format.units_per_px() <= static_cast<float>(max_surface_sample(format));
  };
  while (format.fraction_bits > kMinFractionBits && !fits()) {
    --format.fraction_bits;
  }
  return format;
}

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

SurfaceWeights surface_weights(const SurfaceLattice& lattice, const SurfaceFormat& format) {
  SurfaceWeights weights;
  weights.reach = static_cast<int>(kSurfaceReachPx * format.units_per_px());
  const float unit = std::min(
      static_cast<float>(lattice.unit_weight << 16) / static_cast<float>(weights.reach), 65535.0F);
  std::transform(
      lattice.falloff.begin(), lattice.falloff.end(), weights.share.begin(),
      [&](float falloff) { return static_cast<std::uint16_t>(std::lround(falloff * unit)); });
  return weights;
}

void surface_sample_row_ref(const float* disparity_px, const std::uint8_t* unmatched, int width,
                            const SurfaceFormat& format, std::int16_t* samples) {
  for (int x = 0; x < width; ++x) {
    samples[x] = unmatched[x] != 0 ? kNoSurface : surface_sample(disparity_px[x], format);
  }
}

void fit_surface_row_ref(const SurfaceRow& row, float* fitted_px) {
  const SurfaceLattice lattice = surface_lattice(row.radius_px);
  const float px_per_unit = 1 / row.format.units_per_px();
  for (int x = 0; x < row.width; ++x) {
    if (row.samples[x] == kNoSurface) {
      continue;
    }
    const float height = fit_surface_plane(row.samples + x, row.pitch, lattice, row.format).height;
    if (std::abs(height) < kMaxSurfaceMovePx * row.format.units_per_px()) {
      const float units = static_cast<float>(row.samples[x]) + height;
      fitted_px[x] = std::clamp(row.format.middle_px + units * px_per_unit, row.min_px, row.max_px);
    }
  }
}

}  // namespace vantage::kernels
