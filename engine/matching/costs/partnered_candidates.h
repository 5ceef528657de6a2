#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "engine/matching/costs/displacement_grid.h"
#include "kernels/candidates.h"

namespace vantage {

/// The candidates of one pixel whose partners lie inside the other image.
struct PartneredCandidates {
  kernels::CandidateRange columns;  ///< horizontal disparities
  kernels::CandidateRange rows;     ///< vertical ones

  [[nodiscard]] bool empty() const { return columns.empty() || rows.empty(); }
  [[nodiscard]] int count() const {
    return empty() ? 0 : (columns.end - columns.begin) * (rows.end - rows.begin);
  }
  [[nodiscard]] bool are_all(const DisplacementGrid& grid) const { return count() == grid.count(); }
  /// Index among all candidates of candidate `index` of these.
  [[nodiscard]] int candidate(const DisplacementGrid& grid, int index) const {
    const int in_row = columns.end - columns.begin;
    return (rows.begin + index / in_row) * grid.along_rows.count + columns.begin + index % in_row;
  }
  /// Calls visit(cells, packed, count) for each run of these candidates: its position in a column
  /// of cells, and in a packed column that stores only these candidates.
  template <typename Cell, typename Packed, typename Visit>
  void each_run(const DisplacementGrid& grid, Cell* cells, Packed* packed, Visit visit) const {
    const int in_row = columns.end - columns.begin;
    for (int row = rows.begin; row < rows.end; ++row, packed += in_row) {
      visit(cells + static_cast<std::ptrdiff_t>(row) * grid.along_rows.count + columns.begin,
            packed, in_row);
    }
  }
};

/// A geometry in which all `count` candidates of the columns from first_column(count) on have
/// partners, so that kernels process all of them.
inline kernels::CandidateGeometry all_partnered(int count, int columns) {
  return {.width = columns + 2 * count, .disparity_min = 0, .count = count};
}
inline int first_partnered_column(int count) { return count; }

}  // namespace vantage
