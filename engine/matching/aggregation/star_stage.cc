#include "engine/matching/aggregation/star_stage.h"

#include "kernels/cells/fixed_energy.h"

namespace vantage {

template <typename Cell>
kernels::CellStarRow<Cell> CellStarStage<Cell>::star(const scheduler::RowTask& task, int pitch,
                                                     const Cell* neutral) const {
  const auto offset = [&task](const scheduler::InputRows& rows, int column_cells) {
    return static_cast<std::ptrdiff_t>(task.columns.begin - rows.columns().begin) * column_cells;
  };
  kernels::CellStarRow<Cell> star;
  star.lanes = lanes_;
  star.columns = task.columns.size();
  star.pitch = pitch;
  star.centre = task.input.row<Cell>(task.y) + offset(task.input, pitch);
  const auto neighbour_row = [&](int y, const Cell*& cells, std::ptrdiff_t& cells_pitch) {
    if (y >= task.input.rows().begin && y < task.input.rows().end) {
      cells = task.input.row<Cell>(y) + offset(task.input, pitch);
      cells_pitch = pitch;
    } else {
      cells = neutral != nullptr ? neutral : star.centre;
      cells_pitch = neutral != nullptr ? 0 : pitch;
    }
  };
  neighbour_row(task.y - 1, star.up, star.up_pitch);
  neighbour_row(task.y + 1, star.down, star.down_pitch);
  const Cell* const last = star.centre + static_cast<std::ptrdiff_t>(star.columns - 1) * pitch;
  const auto outside = [neutral](const Cell* own) { return neutral != nullptr ? neutral : own; };
  star.left_of_first =
      task.columns.begin > task.input.columns().begin ? star.centre - pitch : outside(star.centre);
  star.right_of_last = task.columns.end < task.input.columns().end ? last + pitch : outside(last);
  if (reads_source()) {
    star.source = task.source.row<Cell>(task.y) + offset(task.source, lanes_);
  }
  return star;
}

template class CellStarStage<float>;
template class CellStarStage<kernels::FixedEnergy>;

}  // namespace vantage
