#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "kernels/surface_fit/surface_blocks.h"
#include "kernels/surface_fit/surface_plane.h"

namespace vantage::kernels {

SurfaceLattice surface_block_lattice(int radius_px) {
  SurfaceLattice lattice = surface_lattice(surface_block_margin(radius_px));
  lattice.unit_weight = 64;  // leaves some steps to the corners, which weigh a quarter
  for (std::size_t i = 0; i < lattice.falloff.size(); ++i) {
    lattice.falloff[i] =
        static_cast<float>(std::exp(-static_cast<double>(i) / kSurfaceFalloffSteps2));
  }
  return lattice;
}

void surface_block_row_ref(const SurfaceBlockRow& row, const SurfaceFormat& format,
                           std::int16_t* blocks) {
  for (int x = 0; x < row.width; x += 2) {
    const auto value = [&](const float* px, const std::uint8_t* unmatched, int column) {
      return px != nullptr && column < row.width && unmatched[column] == 0 ? px[column]
                                                                           : kNoBlockPx;
    };
    const std::array<float, 4> values = {value(row.upper_px, row.upper_unmatched, x),
                                         value(row.upper_px, row.upper_unmatched, x + 1),
                                         value(row.lower_px, row.lower_unmatched, x),
                                         value(row.lower_px, row.lower_unmatched, x + 1)};
    const float lowest = std::min(std::min(values[0], values[1]), std::min(values[2], values[3]));
    float rise = 0;
    float count = 0;
    for (const float one : values) {
      if (one - lowest < kSurfaceBlockRangePx) {
        rise += one - lowest;
        count += 1;
      }
    }
    blocks[x / 2] =
        lowest == kNoBlockPx ? kNoSurface : surface_sample(lowest + rise / count, format);
  }
}

void fit_surface_block_row_ref(const SurfaceRow& blocks, const SurfaceBlockRow& row) {
  const SurfaceLattice lattice = surface_block_lattice(blocks.radius_px);
  const SurfaceQuarterBlock quarter = surface_quarter_block(lattice);
  const float px_per_unit = 1 / blocks.format.units_per_px();
  for (int x = 0; x < row.width; ++x) {
    const std::int16_t* centre = blocks.samples + x / 2;
    if (*centre == kNoSurface) {
      continue;
    }
    const SurfacePlane<float> plane =
        fit_surface_plane(centre, blocks.pitch, lattice, blocks.format);
    const float per_column = plane.slope_u * quarter.along - plane.slope_v * quarter.across;
    const float per_row = plane.slope_u * quarter.across + plane.slope_v * quarter.along;
    const float middle = static_cast<float>(*centre) + plane.height;
    const auto take = [&](float row_units, const std::uint8_t* unmatched, float& px) {
      const float units = x % 2 == 0 ? row_units - per_column : row_units + per_column;
      const float plane_px = blocks.format.middle_px + units * px_per_unit;
      if (unmatched[x] == 0 && std::abs(plane_px - px) < kMaxSurfaceMovePx) {
        px = std::clamp(plane_px, blocks.min_px, blocks.max_px);
      }
    };
    take(middle - per_row, row.upper_unmatched, row.upper_px[x]);
    if (row.lower_px != nullptr) {
      take(middle + per_row, row.lower_unmatched, row.lower_px[x]);
    }
  }
}

}  // namespace vantage::kernels
