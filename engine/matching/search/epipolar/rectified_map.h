#pragma once

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/side.h"
#include "engine/rectification/rectifier.h"

namespace vantage {

/// Brings a map of a photograph to the pixels of the rectified image, as view synthesis takes maps:
/// each gets the values of the photograph's nearest pixel; unknown and unmatched where the
/// photograph has none. The opposite of PhotographGrid. `map` has the rectifier's size; its empty
/// images stay empty. Identical for any `execution`.
void bring_to_rectified(const Rectifier& rectifier, Side side, Execution& execution,
                        MatchedMap& map);

}  // namespace vantage
