#pragma once

#include <cstddef>

#include "engine/matching/levels/candidate_blocks.h"
#include "kernels/cells/fixed_energy.h"
#include "kernels/star_row.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Stars for runs of columns of a pruned level. Neighbours in tiles with other blocks are
/// rearranged to the blocks of the run; cells that such a neighbour lacks become `absent`.
class BlockStars {
 public:
  using Cell = kernels::FixedEnergy;

  /// `blocks` must outlive the stars.
  BlockStars(const CandidateBlocks& blocks, Cell absent) : blocks_(blocks), absent_(absent) {}

  /// Working memory for one star at a time.
  [[nodiscard]] std::size_t work_cells() const {
    return static_cast<std::size_t>(2 * CandidateBlocks::kMaxRunColumns + 2) *
           static_cast<std::size_t>(blocks_.lanes());
  }
  /// The star of `run` in row task.y, with its source if the task has one. `neutral`: the column
  /// used for neighbours outside the image. `work`: work_cells(), 64-byte aligned; the star may
  /// point into it.
  [[nodiscard]] kernels::CellStarRow<Cell> star(const scheduler::RowTask& task,
                                                const CandidateBlocks::Run& run,
                                                const Cell* neutral, Cell* work) const;

 private:
  [[nodiscard]] const Cell* column(const scheduler::InputRows& rows, int x, int y) const {
    return rows.row<Cell>(y) +
           static_cast<std::ptrdiff_t>(x - rows.columns().begin) * blocks_.lanes();
  }
  const Cell* beside(const scheduler::RowTask& task, const CandidateBlocks::Run& run, int x,
                     Cell* work) const;

  const CandidateBlocks& blocks_;
  Cell absent_;
};

}  // namespace vantage
