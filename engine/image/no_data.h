#pragma once

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

// Rasters of satellites and other surveys: float values of any scale, NaN where there is no data.
// One channel.

/// Whether any pixel has data.
bool has_data(ImageView<const float> raster);

/// The raster as a 16-bit photograph that matchers read: from the 0.5th to the 99.5th percentile of
/// its data, values beyond clipped. Pixels without data get the value of the nearest one in their
/// row that has some, rows without data those of the nearest row with some: nothing that could be
/// taken for texture, and no value that filters would spread. The raster has data. Identical for
/// any `execution`.
Photograph photograph_without_gaps(ImageView<const float> raster, Execution& execution);

/// The left image's disparities, NaN where they are not matched, where the left raster has no data,
/// and where they lead to a pixel of the right raster that has none or is outside. All of one size,
/// else Error. Identical for any `execution`.
void disparities_of_data(const MatchedMap& map, ImageView<const float> left,
                         ImageView<const float> right, Execution& execution,
                         DisparityMap& disparities_px);

}  // namespace vantage
