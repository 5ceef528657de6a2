#pragma once

#include <algorithm>
#include <cstddef>

namespace vantage::kernels {

/// Two neighbouring rows of cells that become one row of a grid of half the size: block b holds
/// columns 2·b and 2·b + 1 of both. Where the grid has an odd number of columns or rows, what is
/// missing of a block is a copy of what is there: of a sum the share of four cells, of a mean
/// nothing new.
template <typename Cell>
struct BlockRow {
  const Cell* upper = nullptr;
  const Cell* lower = nullptr;  ///< `upper` itself below the last of an odd number of rows
  int columns = 0;              ///< of the finer grid, from an even one on; ≥ 1
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
