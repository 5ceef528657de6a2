#pragma once

#include "engine/execution.h"
#include "engine/image/displacement_view.h"
#include "engine/image/image.h"
#include "engine/image/side.h"
#include "engine/refinement/refinement_options.h"

namespace vantage {

/// Marks the pixels of one map that the other image's map contradicts (EQUATIONS §5.2, (5.13)).
/// Maps of equal size, NaN = unknown; tolerance_px ≥ 1. The mask is resized to the map. Identical
/// for any `execution`.
void cross_check(ImageView<const float> map_px, ImageView<const float> other_px, Side side,
                 double tolerance_px, Execution& execution, Mask& unmatched);

/// The same for two components: a pixel is matched if its partner in both directions (rounded) is
/// inside, known, and both components agree.
void cross_check(const DisplacementView& map, const DisplacementView& other, Side side,
                 double tolerance_px, Execution& execution, Mask& unmatched);

/// Marks the pixels without a disparity.
void mark_unknown(ImageView<const float> map_px, Execution& execution, Mask& unknown);

/// Marks as unmatched (255), beside those that are, the pixels whose confidence is at most
/// `threshold` or unknown (5.14). Views of equal size. Identical for any `execution`.
void mark_unsure(ImageView<const float> confidence, double threshold, Execution& execution,
                 Mask& unmatched);

/// Fills unmatched pixels (EQUATIONS §5.4): at constant depth, with Fill::kLinear along a line
/// where the disparities at both ends of a run differ by at most 1 px, with Fill::kNone as unknown
/// (NaN). Fill::kMedian is constant depth here, which take_filled_medians() goes on from. Unless
/// none, a row without any matched pixel copies the nearest row that has one, the upper of two as
/// near; a map without any keeps its values. Identical for any `execution`.
void fill_unmatched(const Mask& unmatched, Side side, Fill fill, Execution& execution,
                    DisparityMap& map_px);

}  // namespace vantage
