#pragma once

#include <cstddef>

#include "kernels/candidates.h"
#include "kernels/star_row.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Common base of iterations on a disparity space: a cell depends on itself, its four neighbours of
/// equal disparity and optionally on the chain's first stage. Cell: float or kernels::FixedEnergy.
template <typename Cell>
class CellStarStage : public scheduler::RowStage {
 public:
  CellStarStage(const kernels::CandidateGeometry& geometry, int height)
      : RowStage({geometry.width, height}), lanes_(geometry.lanes()), count_(geometry.count) {}

  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(Cell) * static_cast<std::size_t>(lanes_);
  }
  [[nodiscard]] scheduler::Range input_rows(int y, scheduler::Extent input) const override {
    return scheduler::Range{y, y + 1}.widened(1, input.all_rows());
  }
  [[nodiscard]] scheduler::Range input_columns(scheduler::Range columns,
                                               scheduler::Extent input) const override {
    return columns.widened(1, input.all_columns());
  }
  [[nodiscard]] int window_rows() const override { return 3; }

 protected:
  [[nodiscard]] int lanes() const { return lanes_; }
  [[nodiscard]] int count() const { return count_; }

  /// The star of a task whose input columns are `pitch` cells apart. `neutral`: the column used for
  /// neighbours outside the image; null: the centre column is used.
  [[nodiscard]] kernels::CellStarRow<Cell> star(const scheduler::RowTask& task, int pitch,
                                                const Cell* neutral) const;

 private:
  int lanes_;
  int count_;
};

using StarStage = CellStarStage<float>;

}  // namespace vantage
