#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Moves the discontinuities of one row of a disparity map to intensity edges (EQUATIONS §5.1).
///
/// A discontinuity is a place between columns b and b+1 where the known disparities differ by more
/// than 1 px. It moves to the nearest place p (between p and p+1) that is adjacent to an edge, that
/// is edges[p] ≠ 0 or edges[p+1] ≠ 0, if there is one with |p − b| ≤ most_px; of two as near, to
/// the left one. The columns passed take the disparity at the side that grows. Discontinuities move
/// from left to right through the row and never to or across one another, neither where the others
/// were nor where they have moved to, and never across unknown disparities (NaN), which keep as
/// they are.
///
/// `width` values each; most_px ≥ 0.
void snap_discontinuities_row(const std::uint8_t* edges, int most_px, int width,
                              float* disparity_px);

}  // namespace vantage::kernels
