#pragma once

#include <cstddef>

namespace vantage::kernels {

/// One row of a simultaneous (Jacobi) iteration on a disparity space: every cell and its four
/// neighbours of equal disparity. Rows are `[column][lane]`; columns are aligned to kLaneMultiple
/// cells.
///
/// A neighbour outside the image is replaced by a column that is neutral for the iteration.
/// up_pitch and down_pitch are 0 where one such column replaces a whole row.
template <typename Cell>
struct CellStarRow {
  const Cell* centre = nullptr;
  const Cell* up = nullptr;
  const Cell* down = nullptr;
  const Cell* left_of_first = nullptr;  ///< left neighbour of the first column
  const Cell* right_of_last = nullptr;  ///< right neighbour of the last column
  std::ptrdiff_t pitch = 0;             ///< cells between columns of the input
  std::ptrdiff_t up_pitch = 0;
  std::ptrdiff_t down_pitch = 0;
  /// The disparity space before the first iteration, `lanes` cells per column; for iterations that
  /// read it.
  const Cell* source = nullptr;
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple

  [[nodiscard]] const Cell* left_of(int column) const {
    return column == 0 ? left_of_first : centre + (column - 1) * pitch;
  }
  [[nodiscard]] const Cell* right_of(int column) const {
    return column + 1 == columns ? right_of_last : centre + (column + 1) * pitch;
  }
};

using StarRow = CellStarRow<float>;

}  // namespace vantage::kernels
