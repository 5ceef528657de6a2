#include "engine/matching/levels/block_star.h"

#include <algorithm>

namespace vantage {

kernels::CellStarRow<BlockStars::Cell> BlockStars::star(const scheduler::RowTask& task,
                                                        const CandidateBlocks::Run& run,
                                                        const Cell* neutral, Cell* work) const {
  const scheduler::InputRows& input = task.input;
  const auto lanes = static_cast<std::ptrdiff_t>(run.blocks.size()) * kernels::kLaneMultiple;
  kernels::CellStarRow<Cell> star;
  star.lanes = static_cast<int>(lanes);
  star.columns = run.columns.size();
  star.pitch = blocks_.lanes();
  star.centre = column(input, run.columns.begin, task.y);
  star.source = column(task.source, run.columns.begin, task.y);
  const auto neighbour_row = [&](int y, const Cell*& cells, std::ptrdiff_t& pitch) {
    if (y < input.rows().begin || y >= input.rows().end) {
      cells = neutral;
      pitch = 0;
    } else if (blocks_.has_blocks_of(run, task.y, y)) {
      cells = column(input, run.columns.begin, y);
      pitch = star.pitch;
    } else {
      cells = work;
      pitch = lanes;
      for (int x = run.columns.begin; x < run.columns.end; ++x, work += lanes) {
        copy_blocks(column(input, x, y), blocks_.at(x, y), run.blocks, absent_, work);
      }
    }
  };
  neighbour_row(task.y - 1, star.up, star.up_pitch);
  neighbour_row(task.y + 1, star.down, star.down_pitch);
  const int left = run.columns.begin - 1;
  star.left_of_first = left >= input.columns().begin ? beside(task, run, left, work) : neutral;
  const int right = run.columns.end;
  star.right_of_last =
      right < input.columns().end ? beside(task, run, right, work + lanes) : neutral;
  return star;
}

/// Column x of the row, as neighbour of a run.
const BlockStars::Cell* BlockStars::beside(const scheduler::RowTask& task,
                                           const CandidateBlocks::Run& run, int x,
                                           Cell* work) const {
  const Cell* const cells = column(task.input, x, task.y);
  const BlockList own = blocks_.at(x, task.y);
  if (std::ranges::equal(own, run.blocks)) {
    return cells;
  }
  copy_blocks(cells, own, run.blocks, absent_, work);
  return work;
}

}  // namespace vantage
