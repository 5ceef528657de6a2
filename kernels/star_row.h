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

/// Weights of each column's neighbours, from 0 to 1; the column itself has weight 1. This is
/// diffusion mediated by intensity edges (7.3). Weights of neutral columns may be any finite
/// number.
struct StarWeights {
  const float* beside = nullptr;  ///< [x], x in [0, columns]: between columns x − 1 and x
  const float* above = nullptr;   ///< [x], x in [0, columns): for the column above x
  const float* below = nullptr;   ///< [x]: for the column below x

  [[nodiscard]] bool are_given() const { return beside != nullptr; }
};

/// The weights of a column's four neighbours times the step of diffusion.
struct StarSteps {
  float left;
  float right;
  float up;
  float down;

  static StarSteps of(const StarWeights& weights, float step, int column) {
    return {step * weights.beside[column], step * weights.beside[column + 1],
            step * weights.above[column], step * weights.below[column]};
  }
  [[nodiscard]] float sum() const { return (left + right) + (up + down); }
};

}  // namespace vantage::kernels
