#pragma once

#include <optional>

#include "engine/execution.h"
#include "engine/image/disparity_range.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Range of vertical disparities y_left − y_right to search in an unrectified pair: that of points
/// found in both images (mutually nearest features) without small outlying groups, widened by half
/// a pixel so that sub-pixel positions have neighbours. If it spans more rows than columns, as with
/// cameras one above the other, it also includes find_disparity_range() of the transposed images,
/// because small surfaces have few such points. Empty if the images share too few points.
///
/// Images with a side beyond 640 pixels are reduced. Throws Error when sizes differ. Identical for
/// any `execution`. Thread rule: may be called concurrently.
std::optional<DisparityRange> find_vertical_range(const Photograph& left, const Photograph& right,
                                                  Execution& execution);

/// The range found; throws Error where there is none.
DisparityRange require_vertical_range(const std::optional<DisparityRange>& found);

}  // namespace vantage
