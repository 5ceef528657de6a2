#pragma once

#include <vector>

#include "scheduler/range.h"

namespace vantage {

/// The grid of the next coarser level: half as many columns and rows, rounded up.
inline scheduler::Extent coarser_extent(scheduler::Extent extent) {
  return {(extent.columns + 1) / 2, (extent.rows + 1) / 2};
}

/// Sizes of an image and its coarser levels, each half as many columns and rows, rounded up:
/// `levels` of them, or fewer if a level would be a single pixel.
std::vector<scheduler::Extent> level_extents(scheduler::Extent extent, int levels);

}  // namespace vantage
