#pragma once

#include <vector>

#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "engine/matching/selection/cyclopean_map.h"

namespace vantage::apps {

// Cameras one above the other: columns are matched as rows of transposed images.

void transpose(std::vector<Photograph>& images);
/// Exchanges the components of a two-dimensional search, too.
void transpose(DisparityMaps& maps);
/// Nothing where there is no map.
void transpose(CyclopeanMap& map);

}  // namespace vantage::apps
