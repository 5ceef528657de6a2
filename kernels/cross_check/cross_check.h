#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Marks the pixels of one row of a disparity map that the other image's map contradicts (5.13):
/// unmatched[x] = 255 when own_px[x] is unknown (NaN), when the partner column
/// floor(x + direction · d + ½) is outside the row, when the other map is unknown there, or when
/// |own − other| ≥ tolerance_px; else 0. direction is −1 for the left map, +1 for the right one.
/// `width` values each. Identical on every instruction set and to the reference.
void cross_check_row(const float* own_px, const float* other_px, int direction, double tolerance_px,
                     int width, std::uint8_t* unmatched);
void cross_check_row_ref(const float* own_px, const float* other_px, int direction,
                         double tolerance_px, int width, std::uint8_t* unmatched);

}  // namespace vantage::kernels
