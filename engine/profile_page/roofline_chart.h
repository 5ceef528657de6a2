#pragma once

#include <string>
#include <vector>

#include "engine/profiling/profile.h"
#include "engine/profiling/roofline.h"

namespace vantage {

/// SVG: GFLOP/s against operations per byte, both logarithmic, of one thread. Lines are its roofs;
/// a disc is a stage that knows its work, its area the time it takes. Empty if no stage does.
std::string roofline_chart(const std::vector<StageProfile>& stages, const ThreadRoofs& roofs);

}  // namespace vantage
