#pragma once

#include "engine/execution.h"
#include "engine/image/disparity_range.h"
#include "engine/image/image.h"
#include "engine/refinement/smooth_surface.h"

namespace vantage {

/// Fills the uniform pixels (≠ 0 in `uniform`) of a map with their canonical depth (EQUATIONS
/// §5.9): each 4-connected region becomes the surface of minimum `energy` through the matched
/// pixels (0 in `unmatched`) around it, its ends, clamped to `range`. Where the nearest matched
/// pixels on both sides of a run along a row or column differ by more than 1 px and a tenth of a
/// pixel per pixel between them, one is of another surface and is left out: the one that alone
/// differs from the run's mean by more than 10 grey levels, else the nearer one. Filled pixels
/// become 0 in `unmatched`; regions without ends stay as they are. `grey`: grey levels of the map's
/// own image. All have one size. Identical for any `execution`.
void fill_canonically(const Mask& uniform, const Image<float>& grey, SurfaceEnergy energy,
                      DisparityRange range, Execution& execution, Mask& unmatched,
                      DisparityMap& map_px);

}  // namespace vantage
