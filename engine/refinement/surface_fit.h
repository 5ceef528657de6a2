#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/execution.h"
#include "engine/image/disparity_range.h"
#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "engine/image/tile_mask.h"

namespace vantage {

/// Working memory of fit_surface(), reused from call to call.
struct SurfaceFitWork {
  Image<std::int16_t> samples;  ///< matched disparities of pixels or blocks, with margins
};

inline std::size_t held_bytes(const SurfaceFitWork& work) { return held_bytes(work.samples); }

/// Replaces matched pixels (0 in `unmatched`) by values of planes fitted to the matched disparities
/// within radius_px columns and rows (kernels/surface_fit), because winners and sub-pixel fits are
/// biased towards whole pixels. All planes are fitted to the input map, so results do not depend on
/// the order. Values stay within `search`, the map's search range: a slope at its end would leave
/// it. Its width decides to how many bits samples are rounded (kernels::surface_format). radius_px
/// from 1 to kernels::kMaxSurfaceRadiusPx. step_px: 1, a plane for each pixel; 2, for each block of
/// 2×2 pixels (kernels/surface_fit/surface_blocks.h). `unmatched` has the size of the map, whose
/// matched pixels are finite. tiles, of an even side: the only ones whose values are needed; those
/// of others are the map's or fitted; null: all. Identical for any `execution`.
void fit_surface(const Mask& unmatched, int radius_px, int step_px, DisparityRange search,
                 Execution& execution, SurfaceFitWork& work, DisparityMap& map_px,
                 const TileMask* tiles = nullptr);

}  // namespace vantage
