#pragma once

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/match_options.h"

namespace vantage {

/// The range of disparities to search in a rectified pair, from cumulative responses (5.5.1) of
/// small tiles to disparities from −width/8 to width/3. The range is that of the dominant
/// disparities of tiles with a distinct peak that the other image and a neighbour confirm, widened
/// by a tenth and a few pixels on both sides. Meant for photographs: a surface smaller than some
/// 32×16 pixels can be missed. Images wider than 1919 pixels are reduced first.
///
/// Throws Error when sizes differ, or when no tile is distinct: constant images, or unrelated
/// ones. Identical for any `execution` and on every instruction set. Thread rule: may be called
/// concurrently.
DisparityRange estimate_disparity_range(const Photograph& left, const Photograph& right,
                                        Execution& execution);

}  // namespace vantage
