#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Quantised costs (cost + offset) · scale must lie in [0, kColumnSumCellLimit).
inline constexpr float kColumnSumCellLimit = 4194304.0F;  // 2²²

/// One step of column sums of float costs. Costs become integers so that running sums are exact: q
/// = (cost + offset) · scale rounded to the nearest integer, ties to even. One row enters the
/// window and one leaves it; either may be null (outside the image).
struct ColumnSum {
  const float* entering = nullptr;
  const float* leaving = nullptr;
  float offset = 0;
  float scale = 1;
  int count = 0;  ///< cells per row: columns · lanes, a multiple of kLaneMultiple
};

/// sums[i] = previous[i] + q(entering[i]) − q(leaving[i]). Exact modulo 2³². `previous` may be the
/// same row as `sums`. Identical on every instruction set.
void column_sum_row(const ColumnSum& row, const std::int32_t* previous, std::int32_t* sums);

}  // namespace vantage::kernels
