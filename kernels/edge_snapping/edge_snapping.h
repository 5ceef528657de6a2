#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Moves the discontinuities of one row of a disparity map to intensity edges (EQUATIONS §5.1).
///
/// A discontinuity is a position between columns b and b+1 whose known disparities differ by more
/// than 1 px. It moves to the nearest position p (between p and p+1) that is adjacent to an edge,
/// i.e. edges[p] ≠ 0 or edges[p+1] ≠ 0, if there is one with |p − b| ≤ max_px; on ties to the left
/// one. The columns it passes take the disparity of the side that grows. Discontinuities are
/// processed from left to right. They never move to or across the old or new position of another
/// one, and never across unknown disparities (NaN), which are unchanged.
///
/// `width` values each; max_px ≥ 0.
void snap_discontinuities_row(const std::uint8_t* edges, int max_px, int width,
                              float* disparity_px);

}  // namespace vantage::kernels
