#pragma once

#include <cstddef>

#include "engine/execution.h"
#include "engine/image/disparity_range.h"
#include "engine/image/image.h"
#include "engine/refinement/filled_medians.h"
#include "engine/refinement/other_camera_view.h"
#include "engine/refinement/surface_tiles.h"

namespace vantage {

/// Working memory of fill_by_surfaces(), reused from call to call.
struct SurfaceFillWork {
  SurfaceTiles surfaces;
  Image<float> seen_px;  ///< what the other camera sees, one row for a row of blocks
};

inline std::size_t held_bytes(const SurfaceFillWork& work) {
  return held_bytes(work.surfaces) + held_bytes(work.seen_px);
}

/// Fills unmatched pixels (≠ 0 in `unmatched`) again, by the surfaces around them, where these
/// agree and the other camera does not see the pixel, or would see through its value (EQUATIONS
/// §5.7); others keep their values. medians: after frame_photograph() of the map's own photograph.
/// search: values stay within it. Identical for any `execution`.
void fill_by_surfaces(const Mask& unmatched, const OtherCameraView& other,
                      const FilledMediansWork& medians, DisparityRange search, Execution& execution,
                      SurfaceFillWork& work, DisparityMap& map_px);

}  // namespace vantage
