#include "scheduler/sweep_layout.h"

#include <algorithm>

#include "scheduler/scratch_pool.h"

namespace vantage::scheduler {
namespace {

std::size_t aligned(std::size_t bytes) {
  constexpr std::size_t step = ScratchPool::kAlignment;
  return (bytes + step - 1) / step * step;
}

/// The smallest range that holds both; an empty one holds nothing.
Range hull(Range a, Range b) {
  if (a.empty() || b.empty()) {
    return a.empty() ? b : a;
  }
  return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

/// Gives `part` its columns, first row and place in the scratch.
void place(StageSweep& part, Extent input, Range columns, int row, int ring_rows,
           std::size_t& bytes) {
  const RowStage& stage = *part.stage;
  part.reads_source = stage.reads_source();
  part.columns = columns;
  part.first_row = stage.sweep_start(row);
  part.row_bytes = aligned(stage.bytes_per_column() * static_cast<std::size_t>(columns.size()));
  part.ring_rows = ring_rows;
  part.ring_offset = bytes;
  bytes += part.row_bytes * static_cast<std::size_t>(ring_rows);
  part.state_offset = bytes;
  bytes += aligned(stage.state_bytes(columns, input));
}

}  // namespace

void lay_out_sweep(const PassStages& pass, Range columns, Range rows, SweepLayout& layout) {
  const std::size_t beside = pass.source == nullptr ? 0 : 1;
  layout.parts.assign(pass.stages.size() + beside, {});
  std::size_t bytes = 0;
  Range wanted_columns = columns;
  int wanted_row = rows.begin;
  int ring_rows = 1;  // of the stage at hand: what the stage after it looks at together
  Range source_columns;
  int source_row = rows.begin;
  for (std::size_t k = pass.stages.size(); k-- > 0;) {
    const RowStage& stage = *pass.stages[k];
    const Extent input = k > 0 ? pass.stages[k - 1]->extent() : pass.input;
    StageSweep& part = layout.parts[k + beside];
    part.stage = &stage;
    if (k == 0 && pass.source == nullptr && pass.source_rows > 0) {
      wanted_columns = hull(wanted_columns, source_columns);
      wanted_row = std::min(wanted_row, source_row);
      ring_rows = std::max(ring_rows, pass.source_rows);
    }
    place(part, input, wanted_columns, wanted_row, ring_rows, bytes);
    if (part.reads_source) {
      source_columns = hull(source_columns, part.columns);
      source_row = std::min(source_row, part.first_row);
    }
    wanted_columns = stage.input_columns(wanted_columns, input);
    wanted_row = stage.input_rows(part.first_row, input).begin;
    ring_rows = stage.window_rows();
  }
  if (pass.source != nullptr) {
    layout.parts[0].stage = pass.source;
    place(layout.parts[0], {}, source_columns, source_row, pass.source_rows, bytes);
  }
  layout.scratch_bytes = bytes;
}

}  // namespace vantage::scheduler
