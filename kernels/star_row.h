#pragma once

#include <cstddef>

namespace vantage::kernels {

/// One row of a simultaneous (Jacobi) iteration on a disparity space: every cell and its four
/// neighbours of equal disparity. Rows are `[column][lane]`, 64-byte aligned columns.
///
/// A missing neighbour at the border of the image is replaced by whatever column is neutral for the
/// iteration: up_pitch and down_pitch are 0 where a whole row is replaced by one column.
struct StarRow {
  const float* centre = nullptr;
  const float* up = nullptr;
  const float* down = nullptr;
  const float* left_of_first = nullptr;  ///< left neighbour of the first column
  const float* right_of_last = nullptr;  ///< right neighbour of the last column
  std::ptrdiff_t pitch = 0;              ///< floats from column to column of the input
  std::ptrdiff_t up_pitch = 0;
  std::ptrdiff_t down_pitch = 0;
  /// The disparity space before the first iteration, `lanes` floats a column; for iterations that
  /// look at it again.
  const float* source = nullptr;
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple

  [[nodiscard]] const float* left_of(int column) const {
    return column == 0 ? left_of_first : centre + (column - 1) * pitch;
  }
  [[nodiscard]] const float* right_of(int column) const {
    return column + 1 == columns ? right_of_last : centre + (column + 1) * pitch;
  }
};

}  // namespace vantage::kernels
