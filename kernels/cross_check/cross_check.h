#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Marks the pixels of one row of a disparity map that the other image's map contradicts (5.13).
/// unmatched[x] = 255 if own_px[x] is unknown (NaN), if the partner column floor(x + direction · d
/// + ½) is outside the row, if the other map is unknown there, or if |own − other| ≥ tolerance_px;
/// otherwise 0. direction is −1 for the left map, +1 for the right one. `width` values each.
/// Identical on every instruction set and to the reference.
void cross_check_row(const float* own_px, const float* other_px, int direction, double tolerance_px,
                     int width, std::uint8_t* unmatched);
void cross_check_row_ref(const float* own_px, const float* other_px, int direction,
                         double tolerance_px, int width, std::uint8_t* unmatched);

}  // namespace vantage::kernels
