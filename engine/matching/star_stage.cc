#include "engine/matching/star_stage.h"

namespace vantage {

kernels::StarRow StarStage::star(const scheduler::RowTask& task, int pitch,
                                 const float* neutral) const {
  const auto offset = [&task](const scheduler::InputRows& rows, int column_floats) {
    return static_cast<std::ptrdiff_t>(task.columns.begin - rows.columns().begin) * column_floats;
  };
  kernels::StarRow star;
  star.lanes = lanes_;
  star.columns = task.columns.size();
  star.pitch = pitch;
  star.centre = task.input.row<float>(task.y) + offset(task.input, pitch);
  const auto neighbour_row = [&](int y, const float*& cells, std::ptrdiff_t& cells_pitch) {
    if (y >= task.input.rows().begin && y < task.input.rows().end) {
      cells = task.input.row<float>(y) + offset(task.input, pitch);
      cells_pitch = pitch;
    } else {
      cells = neutral != nullptr ? neutral : star.centre;
      cells_pitch = neutral != nullptr ? 0 : pitch;
    }
  };
  neighbour_row(task.y - 1, star.up, star.up_pitch);
  neighbour_row(task.y + 1, star.down, star.down_pitch);
  const float* const last = star.centre + static_cast<std::ptrdiff_t>(star.columns - 1) * pitch;
  const auto outside = [neutral](const float* own) { return neutral != nullptr ? neutral : own; };
  star.left_of_first =
      task.columns.begin > task.input.columns().begin ? star.centre - pitch : outside(star.centre);
  star.right_of_last = task.columns.end < task.input.columns().end ? last + pitch : outside(last);
  if (reads_source()) {
    star.source = task.source.row<float>(task.y) + offset(task.source, lanes_);
  }
  return star;
}

}  // namespace vantage
