#pragma once

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Enlarges a refined map of half the size, with disparities in full-size pixels, to the size of
/// `image` (EQUATIONS §5.8): linearly within a surface; at jumps a pixel takes the disparity of the
/// one of the four nearest columns that looks like it. Masks and confidence are repeated. `image`,
/// `half_image`: 8-bit grey, full and half size. Identical for any `execution`.
void enlarge_map(const MatchedMap& half, const Photograph& image, const Photograph& half_image,
                 Execution& execution, MatchedMap& map);

}  // namespace vantage
