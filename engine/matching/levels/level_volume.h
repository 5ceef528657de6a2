#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "scheduler/range.h"

namespace vantage {

/// Storage of a coarse level between two chains: cells of one or two bytes, `lanes` per column, the
/// columns of a row contiguous. Writer and reader agree on the meaning. Working memory, reused
/// without reallocation. Thread rule: as for a plain array.
class LevelVolume {
 public:
  /// Contents are then undefined. cell_bytes: 1 or 2.
  void resize(scheduler::Extent extent, int lanes, int cell_bytes) {
    extent_ = extent;
    lanes_ = lanes;
    cell_bytes_ = cell_bytes;
    bytes_.resize(extent.columns, extent.rows, lanes * cell_bytes);
  }

  [[nodiscard]] scheduler::Extent extent() const { return extent_; }
  [[nodiscard]] int lanes() const { return lanes_; }
  [[nodiscard]] int cell_bytes() const { return cell_bytes_; }
  [[nodiscard]] std::size_t held_bytes() const { return vantage::held_bytes(bytes_); }

  /// First cell of column x in row y. sizeof(Cell) is the cell_bytes of resize().
  template <typename Cell>
  [[nodiscard]] Cell* column(int x, int y) {
    return reinterpret_cast<Cell*>(bytes_.row(y) + offset(x));
  }
  template <typename Cell>
  [[nodiscard]] const Cell* column(int x, int y) const {
    return reinterpret_cast<const Cell*>(bytes_.row(y) + offset(x));
  }

 private:
  [[nodiscard]] std::ptrdiff_t offset(int x) const {
    return static_cast<std::ptrdiff_t>(x) * lanes_ * cell_bytes_;
  }

  scheduler::Extent extent_;
  int lanes_ = 0;
  int cell_bytes_ = 1;
  Image<std::uint8_t> bytes_;
};

}  // namespace vantage
