#pragma once

#include <cstdint>

#include "engine/execution.h"
#include "engine/image/displacement_view.h"
#include "engine/image/image.h"
#include "engine/image/side.h"
#include "engine/refinement/refinement_options.h"

namespace vantage {

/// Marks the pixels of one map that contradict the other image's map (EQUATIONS §5.2, (5.13)). Maps
/// of equal size, NaN = unknown; tolerance_px ≥ 1; columns_per_px: of disparity, > 0: ½ for maps of
/// half the size, the ratio of two baselines. Resizes the mask to the map. Identical for any
/// `execution`.
void cross_check(ImageView<const float> map_px, ImageView<const float> other_px, Side side,
                 double tolerance_px, Execution& execution, Mask& unmatched,
                 float columns_per_px = 1);

/// Cross-check of both components: a pixel is matched if its (rounded) partner is inside the image
/// and known, and both components agree.
void cross_check(const DisplacementView& map, const DisplacementView& other, Side side,
                 double tolerance_px, Execution& execution, Mask& unmatched);

/// Marks pixels without a disparity.
void mark_unknown(ImageView<const float> map_px, Execution& execution, Mask& unknown);

/// Also marks as unmatched (255) the pixels whose confidence is unknown or at most `threshold`
/// (5.14). Views of equal size. Identical for any `execution`.
void mark_unsure(ImageView<const float> confidence, double threshold, Execution& execution,
                 Mask& unmatched);

/// Fills unmatched pixels (EQUATIONS §5.4): at constant depth; with Fill::kLinear along a line
/// where the disparities at both ends of a run differ by at most 1 px; with Fill::kNone as unknown
/// (NaN). All others are constant depth here; take_filled_medians() refines it. Except for
/// kNone, a row without matched pixels copies the nearest row that has some (the upper one on a
/// tie), and a map without any is unchanged. Identical for any `execution`.
void fill_unmatched(const Mask& unmatched, Side side, Fill fill, Execution& execution,
                    DisparityMap& map_px);

}  // namespace vantage
