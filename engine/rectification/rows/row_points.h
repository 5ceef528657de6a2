#pragma once

#include <vector>

#include "engine/execution.h"
#include "engine/rectification/feature_matches.h"

namespace vantage {

/// Largest row offset of a point that is found.
inline constexpr int kRowReach_px = 4;

/// Points of a nearly rectified pair: on a coarse grid, the most textured column of each cell, with
/// the partner in `right` at most kRowReach_px rows above or below, to a fraction of a pixel. Found
/// by zero-mean normalized correlation: along the row in reduced images, then at full size; kept if
/// the peak is unique and its row is certain to a third of a pixel. So noise, exposure and blur
/// cost points, not exactness; a few per cent of the points may be wrong. At most 480, in the order
/// of rows; none for images of different sizes or less than 32 pixels high or wide. Takes about 5
/// ms of one thread for any size. `execution`: null, one thread; identical for any. Thread rule:
/// may be called concurrently.
std::vector<PointMatch> find_row_points(const Photograph& left, const Photograph& right,
                                        Execution* execution = nullptr);

}  // namespace vantage
