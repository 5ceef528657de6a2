#pragma once

#include <array>
#include <cstddef>

namespace vantage::kernels {

/// Weights of five neighbouring pixels, the pixel itself in the middle. Shorter filters have zeros
/// at the ends.
using FilterTaps = std::array<float, 5>;
/// Radius of the filters.
inline constexpr int kFilterRadius = 2;

/// One image row, correlated with a separable filter.
struct SeparableFilter {
  std::array<const float*, 5> rows{};  ///< y − 2 … y + 2, with margins of 2 columns on both sides
  FilterTaps down{};                   ///< weights of the rows
  FilterTaps along{};                  ///< weights of the columns
  int width = 0;
};

/// filtered[x] = Σ along[i] · down[k] · rows[k][x + i − 2]. Rows are read, and `filtered` may be
/// written, up to the next multiple of kLaneMultiple after `width` plus the margin. `work`: room
/// for width + 3 · kLaneMultiple floats. Identical on every instruction set.
void separable_filter_row(const SeparableFilter& filter, float* work, float* filtered);

}  // namespace vantage::kernels
