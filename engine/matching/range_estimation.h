#pragma once

#include <optional>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"

namespace vantage {

/// The range of disparities to search in a rectified pair: what a search of the reduced images from
/// −width/8 to width/3 finds in both of them, but for small areas far from all others, and a
/// margin. It begins at 0 or above unless a fiftieth of what is matched is negative. None where the
/// images agree on next to nothing: constant images, or unrelated ones.
///
/// Images of 512 to 1280 pixels width are reduced to a quarter, larger ones to a width of 320, so
/// that the time is a few per cent of what matching takes; surfaces of fewer than some 10 reduced
/// pixels can be missed.
///
/// `vertical` holds the y_left − y_right of a pair whose rows do not correspond.
///
/// Throws Error when sizes differ. Identical for any `execution` and on every instruction set.
/// Thread rule: may be called concurrently.
std::optional<DisparityRange> find_disparity_range(const Photograph& left, const Photograph& right,
                                                   Execution& execution,
                                                   DisparityRange vertical = {0, 0});

/// The same; throws Error when there is none.
DisparityRange estimate_disparity_range(const Photograph& left, const Photograph& right,
                                        Execution& execution);

}  // namespace vantage
