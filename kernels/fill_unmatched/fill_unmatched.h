#pragma once

#include <cstdint>

namespace vantage::kernels {

/// On which side of an unmatched run the half-occluded background lies: left in the left map,
/// right in the right map.
enum class BackgroundSide { kLeft, kRight };

/// Gives every run of unmatched pixels (unmatched[x] ≠ 0) of one row the disparity of the adjacent
/// matched pixel on the background side, or of the other side where the run touches that border of
/// the image (4.6, constant depth). False, and nothing changed, when the row has no matched pixel.
bool fill_unmatched_row(const std::uint8_t* unmatched, BackgroundSide side, int width,
                        float* disparity_px);

/// The same, but runs between two matched pixels whose disparities differ by at most `step_px` are
/// taken for a part of one surface and interpolated linearly between them (4.6).
bool fill_unmatched_row_linearly(const std::uint8_t* unmatched, BackgroundSide side, float step_px,
                                 int width, float* disparity_px);

}  // namespace vantage::kernels
