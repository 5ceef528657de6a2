#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "scheduler/range.h"

namespace vantage {

/// Storage of a coarse level between two chains: cells of one or two bytes, `lanes` per column, the
/// columns of a row contiguous. Writer and reader agree on the meaning. A volume may hold some rows
/// of its level only. Working memory, reused without reallocation. Thread rule: as for a plain
/// array.
class LevelVolume {
 public:
  /// Contents are then undefined. cell_bytes: 1 or 2.
  void resize(scheduler::Extent extent, int lanes, int cell_bytes) {
    describe(extent, lanes, cell_bytes);
    hold(extent.all_rows());
  }
  /// Without memory, until hold().
  void describe(scheduler::Extent extent, int lanes, int cell_bytes) {
    extent_ = extent;
    lanes_ = lanes;
    cell_bytes_ = cell_bytes;
  }
  /// Holds `rows` only, with undefined contents.
  void hold(scheduler::Range rows) {
    first_row_ = rows.begin;
    bytes_.resize(extent_.columns, rows.size(), lanes_ * cell_bytes_);
  }

  /// Size of the whole level, even if only some of its rows are held.
  [[nodiscard]] scheduler::Extent extent() const { return extent_; }
  [[nodiscard]] int lanes() const { return lanes_; }
  [[nodiscard]] int cell_bytes() const { return cell_bytes_; }
  [[nodiscard]] std::size_t held_bytes() const { return vantage::held_bytes(bytes_); }

  /// First cell of column x in row y, which is held. sizeof(Cell) is the cell_bytes of resize().
  template <typename Cell>
  [[nodiscard]] Cell* column(int x, int y) {
    return reinterpret_cast<Cell*>(bytes_.row(y - first_row_) + offset(x));
  }
  template <typename Cell>
  [[nodiscard]] const Cell* column(int x, int y) const {
    return reinterpret_cast<const Cell*>(bytes_.row(y - first_row_) + offset(x));
  }

 private:
  [[nodiscard]] std::ptrdiff_t offset(int x) const {
    return static_cast<std::ptrdiff_t>(x) * lanes_ * cell_bytes_;
  }

  scheduler::Extent extent_;
  int lanes_ = 0;
  int cell_bytes_ = 1;
  int first_row_ = 0;
  Image<std::uint8_t> bytes_;
};

}  // namespace vantage
