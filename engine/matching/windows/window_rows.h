#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/candidate_windows.h"
#include "kernels/window_step/window_step.h"

namespace vantage {

/// A row of values with the margins of windows, zero at first. Move-only.
template <typename T>
class WindowValues {
 public:
  explicit WindowValues(int columns)
      : values_(static_cast<std::size_t>(columns + 2 * kernels::kWindowMargin)) {}
  [[nodiscard]] T* data() { return values_.data() + kernels::kWindowMargin; }
  [[nodiscard]] const T* data() const { return values_.data() + kernels::kWindowMargin; }

 private:
  std::vector<T> values_;
};

/// Rows y, y + 1, … of which a few at a time are kept: row y in place y mod `rows`.
template <typename Row>
class RowRing {
 public:
  RowRing(int rows, int columns) {
    rows_.reserve(static_cast<std::size_t>(rows));
    for (int i = 0; i < rows; ++i) {
      rows_.emplace_back(columns);
    }
  }
  [[nodiscard]] Row& at(int y) { return rows_[static_cast<std::size_t>(y) % rows_.size()]; }

 private:
  std::vector<Row> rows_;
};

/// Cells of both windows of the columns of a row.
struct WindowCellsRow {
  explicit WindowCellsRow(int columns)
      : cells{WindowValues<kernels::WindowCells>(columns),
              WindowValues<kernels::WindowCells>(columns)} {}
  std::array<WindowValues<kernels::WindowCells>, kernels::kWindows> cells;

  [[nodiscard]] std::array<kernels::WindowCells*, kernels::kWindows> data() {
    return {cells[0].data(), cells[1].data()};
  }
};

/// The windows of a row of a level and their start, from one row of the coarser level. Values are
/// repeated for the two columns that a coarse one covers.
struct WindowStartRow {
  explicit WindowStartRow(int columns)
      : support(columns),
        start{WindowValues<std::int16_t>(columns), WindowValues<std::int16_t>(columns)},
        has_second(columns),
        near_second(columns) {}
  WindowCellsRow support;
  std::array<WindowValues<std::int16_t>, kernels::kWindows> start;  ///< first candidates
  WindowValues<std::uint8_t> has_second;                            ///< 255 or 0
  WindowValues<std::uint8_t>
      near_second;  ///< not 0: the column or one beside, above, below has one

  [[nodiscard]] std::array<const std::int16_t*, kernels::kWindows> starts() const {
    return {start[0].data(), start[1].data()};
  }
};

}  // namespace vantage
