#pragma once

#include <algorithm>
#include <cstddef>

namespace vantage::kernels {

/// Two neighbouring rows of cells that are reduced to one row of a grid of half the size. Block b
/// holds columns 2·b and 2·b + 1 of both rows. Where the grid has an odd number of columns or rows,
/// the missing cells of a block are copies of the existing ones. A sum is thus always over four
/// cells; a mean is unaffected.
template <typename Cell>
struct BlockRow {
  const Cell* upper = nullptr;
  const Cell* lower = nullptr;  ///< equal to `upper` at the last row of an odd number of rows
  int columns = 0;              ///< of the finer grid, starting at an even one; ≥ 1
  int lanes = 0;                ///< a multiple of kLaneMultiple

  [[nodiscard]] int blocks() const { return (columns + 1) / 2; }
  [[nodiscard]] std::ptrdiff_t left(int block) const {
    return static_cast<std::ptrdiff_t>(2 * block) * lanes;
  }
  [[nodiscard]] std::ptrdiff_t right(int block) const {
    return static_cast<std::ptrdiff_t>(std::min(2 * block + 1, columns - 1)) * lanes;
  }
};

}  // namespace vantage::kernels
