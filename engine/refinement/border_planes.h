#pragma once

#include "engine/execution.h"
#include "engine/image/disparity_range.h"
#include "engine/image/image.h"
#include "engine/image/side.h"

namespace vantage {

/// Fills the band along a border that the other image never shows: unmatched pixels (≠ 0) that
/// begin a row of a left map, or end one of a right map, whose partners lie outside the image. They
/// continue the plane of the matched pixels beside them, if those are one (EQUATIONS §5.7); other
/// pixels keep their values. pixels_per_column: as in MapToRefine. search: values stay within it.
/// Rows read matched pixels only and are independent: identical for any `execution`.
void fill_border_planes(const Mask& unmatched, Side side, int pixels_per_column,
                        DisparityRange search, Execution& execution, DisparityMap& map_px);

}  // namespace vantage
