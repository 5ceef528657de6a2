#include "scheduler/whole_image_pipeline.h"

#include <vector>

#include "scheduler/scratch_pool.h"

namespace vantage::scheduler {

void run_whole_image(Chain chain) {
  check_source_readers(chain);
  ScratchPool memory;
  std::vector<ScratchPool::Lease> outputs;
  Extent input_extent;
  std::size_t input_row_bytes = 0;
  for (const RowStage* stage : chain) {
    const Extent extent = stage->extent();
    const std::size_t row_bytes =
        stage->bytes_per_column() * static_cast<std::size_t>(extent.columns);
    const ScratchPool::Lease state =
        memory.lease(stage->state_bytes(extent.all_columns(), input_extent));
    outputs.push_back(memory.lease(row_bytes * static_cast<std::size_t>(extent.rows)));
    for (int y = 0; y < extent.rows; ++y) {
      RowTask task;
      task.y = y;
      task.sweep_begins = y == 0;
      task.columns = extent.all_columns();
      task.output = outputs.back().data() + row_bytes * static_cast<std::size_t>(y);
      task.previous = y == 0 ? nullptr : task.output - row_bytes;
      task.state = state.data();
      if (stage != chain.front()) {
        const std::byte* input = outputs[outputs.size() - 2].data();
        task.input = InputRows(input, input_row_bytes, input_extent.rows,
                               stage->input_rows(y, input_extent), input_extent.all_columns());
      }
      if (stage->reads_source()) {
        const RowStage& source = *chain.front();
        const Range columns = source.extent().all_columns();
        task.source =
            InputRows(outputs.front().data(),
                      source.bytes_per_column() * static_cast<std::size_t>(columns.size()),
                      source.extent().rows, {y, y + 1}, columns);
      }
      stage->make_row(task);
    }
    input_extent = extent;
    input_row_bytes = row_bytes;
  }
}

}  // namespace vantage::scheduler
