#pragma once

#include <vector>

#include "scheduler/range.h"

namespace vantage {

/// The grid of the next coarser level: half as many columns and rows, rounded up.
inline scheduler::Extent coarser_extent(scheduler::Extent extent) {
  return {(extent.columns + 1) / 2, (extent.rows + 1) / 2};
}

/// The grids of an image of `extent` and of its coarser levels, half as many columns and rows each,
/// rounded up: `levels` of them, or fewer where a level would be a single pixel.
std::vector<scheduler::Extent> level_extents(scheduler::Extent extent, int levels);

}  // namespace vantage
