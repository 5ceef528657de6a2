#pragma once

#include <cstdint>

namespace vantage::kernels {

/// One row of a disparity map to check.
struct CrossCheckRow {
  const float* own_px = nullptr;      ///< `width` values; NaN: unknown
  int direction = -1;                 ///< −1: the left map, +1: the right one
  double tolerance_px = 1;            ///< > 0
  int width = 0;                      ///< below 2²¹
  std::uint8_t* unmatched = nullptr;  ///< `width` marks; output
  /// > 0: 1, ½ of a map of half the size, or the ratio of two baselines.
  float columns_per_px = 1;
};

/// Marks the pixels of one row of a disparity map that the other image's map contradicts (5.13).
/// unmatched[x] = 255 if own_px[x] is unknown (NaN), if the partner column floor(x + s + ½) with
/// s = direction · columns_per_px · d, rounded to float, is outside the row, if the other map is
/// unknown there, or if |own − other| ≥ tolerance_px; otherwise 0. other_px: `width` values. All
/// else is exact, so identical on every instruction set.
void cross_check_row(const CrossCheckRow& row, const float* other_px);

}  // namespace vantage::kernels
