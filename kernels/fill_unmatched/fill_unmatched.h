#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Side of an unmatched run on which the half-occluded background lies: left in the left map, right
/// in the right map.
enum class BackgroundSide { kLeft, kRight };

/// Fills every run of unmatched pixels (unmatched[x] ≠ 0) of one row with the disparity of the
/// adjacent matched pixel on the background side, or on the other side if the run touches that
/// image border (4.6, constant depth). Returns false, and changes nothing, if the row has no
/// matched pixel.
bool fill_unmatched_row(const std::uint8_t* unmatched, BackgroundSide side, int width,
                        float* disparity_px);

/// Same, but a run between two matched pixels whose disparities differ by at most `step_px` is
/// treated as part of one surface and interpolated linearly between them (4.6).
bool fill_unmatched_row_linearly(const std::uint8_t* unmatched, BackgroundSide side, float step_px,
                                 int width, float* disparity_px);

}  // namespace vantage::kernels
