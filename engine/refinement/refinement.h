#pragma once

#include "engine/execution.h"
#include "engine/image/image.h"

namespace vantage {

/// Marks the unmatched pixels of both maps (EQUATIONS §5.2, (5.13)). Maps of equal size, NaN =
/// unknown; tolerance_px ≥ 1. Masks are resized to the maps. Identical for any `execution`.
void cross_check(ImageView<const float> left_px, ImageView<const float> right_px,
                 double tolerance_px, Execution& execution, Mask& left_unmatched,
                 Mask& right_unmatched);

/// Marks the pixels without a disparity.
void mark_unknown(ImageView<const float> map_px, Execution& execution, Mask& unknown);

/// Which camera a map belongs to: the side of an occlusion on which the background lies.
enum class MapSide { kLeft, kRight };

/// Fills unmatched pixels at constant depth (EQUATIONS §5.4). A row without any matched pixel
/// copies the nearest row that has one, the upper of two as near; a map without any keeps its
/// values. Identical for any `execution`.
void fill_unmatched(const Mask& unmatched, MapSide side, Execution& execution,
                    DisparityMap& map_px);

}  // namespace vantage
