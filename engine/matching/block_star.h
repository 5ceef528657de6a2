#pragma once

#include <cstddef>

#include "engine/matching/candidate_blocks.h"
#include "kernels/star_row.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Stars of runs of columns of a level of which only some candidates are looked at. Neighbours in
/// tiles with other blocks are brought to the blocks of the run; a cell that such a neighbour lacks
/// is `absent`.
class BlockStars {
 public:
  /// `blocks` must outlive the stars.
  BlockStars(const CandidateBlocks& blocks, float absent) : blocks_(blocks), absent_(absent) {}

  /// Of working memory, for one star at a time.
  [[nodiscard]] std::size_t work_floats() const {
    return static_cast<std::size_t>(2 * CandidateBlocks::kMostRunColumns + 2) *
           static_cast<std::size_t>(blocks_.lanes());
  }
  /// The star of `run` in row task.y, its source as far as the task has one. `neutral`: the column
  /// that stands for neighbours outside the image. `work`: work_floats(), 64-byte aligned; the star
  /// may point there.
  [[nodiscard]] kernels::StarRow star(const scheduler::RowTask& task,
                                      const CandidateBlocks::Run& run, const float* neutral,
                                      float* work) const;

 private:
  [[nodiscard]] const float* column(const scheduler::InputRows& rows, int x, int y) const {
    return rows.row<float>(y) +
           static_cast<std::ptrdiff_t>(x - rows.columns().begin) * blocks_.lanes();
  }
  const float* beside(const scheduler::RowTask& task, const CandidateBlocks::Run& run, int x,
                      float* work) const;

  const CandidateBlocks& blocks_;
  float absent_;
};

}  // namespace vantage
