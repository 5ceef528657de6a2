#pragma once

#include <cstddef>

#include "engine/execution.h"
#include "engine/image/disparity_range.h"
#include "engine/image/image.h"
#include "engine/image/memory_use.h"

namespace vantage {

/// Working memory of fit_surface(), reused from call to call.
struct SurfaceFitWork {
  Image<float> matched_px;  ///< the map before, between margins
};

inline std::size_t held_bytes(const SurfaceFitWork& work) { return held_bytes(work.matched_px); }

/// Gives matched pixels (0 in `unmatched`) the values of planes through the matched disparities
/// around them, radius_px columns and rows far (kernels/surface_fit says which): winners and
/// sub-pixel fits are nearer to whole pixels than surfaces are. All planes are fitted to the map as
/// it comes, so results do not depend on the order. Values stay within `search`, the range that the
/// map was searched in: a slope at its end would go on beyond it. radius_px from 1 to
/// kernels::kMaxSurfaceRadiusPx; `unmatched` has the size of the map, whose matched pixels are
/// finite. Identical for any `execution`.
void fit_surface(const Mask& unmatched, int radius_px, DisparityRange search, Execution& execution,
                 SurfaceFitWork& work, DisparityMap& map_px);

}  // namespace vantage
