#include "scheduler/strip_pipeline.h"

#include <algorithm>

namespace vantage::scheduler {
namespace {

/// The state between two passes, as a whole image of cell rows.
struct StoredRows {
  std::byte* base = nullptr;
  std::size_t row_bytes = 0;
  Extent extent;
};

/// The sweep of one pass down one strip and band.
class Sweep {
 public:
  Sweep(Chain pass, const std::vector<StageSweep>& layout, std::byte* scratch, Range rows,
        const StoredRows& input, const StoredRows& output)
      : pass_(pass),
        layout_(layout),
        scratch_(scratch),
        rows_(rows),
        input_(input),
        output_(output),
        next_row_(pass.size()) {
    for (std::size_t k = 0; k < pass.size(); ++k) {
      next_row_[k] = layout[k].first_row;
    }
  }

  void run() { make_rows_until(pass_.size() - 1, rows_.end); }

 private:
  /// Brings stage k to row `end`, and the stages before it as far as that needs: the wavefront.
  void make_rows_until(std::size_t k, int end) {
    while (next_row_[k] < end) {
      const int y = next_row_[k];
      RowTask task;
      task.y = y;
      task.sweep_begins = y == layout_[k].first_row;
      task.columns = layout_[k].columns;
      task.state = scratch_ + layout_[k].state_offset;
      task.output = output_row(k, y);
      task.previous = task.sweep_begins ? nullptr : output_row(k, y - 1);
      task.input = input_rows(k, y);
      pass_[k]->make_row(task);
      ++next_row_[k];
    }
  }

  InputRows input_rows(std::size_t k, int y) {
    if (k == 0) {
      return input_.base == nullptr
                 ? InputRows()
                 : InputRows(input_.base, input_.row_bytes, input_.extent.rows,
                             pass_[0]->input_rows(y, input_.extent), input_.extent.all_columns());
    }
    const StageSweep& source = layout_[k - 1];
    const Range window = pass_[k]->input_rows(y, pass_[k - 1]->extent());
    make_rows_until(k - 1, window.end);
    return {scratch_ + source.ring_offset, source.row_bytes, source.ring_rows, window,
            source.columns};
  }

  std::byte* output_row(std::size_t k, int y) const {
    const StageSweep& part = layout_[k];
    // Rows that only warm up the state of a pass's last stage belong to another band: they go to
    // this task's own row.
    if (k + 1 == pass_.size() && output_.base != nullptr && y >= rows_.begin) {
      return output_.base + output_.row_bytes * static_cast<std::size_t>(y) +
             pass_[k]->bytes_per_column() * static_cast<std::size_t>(part.columns.begin);
    }
    return scratch_ + part.ring_offset +
           part.row_bytes * static_cast<std::size_t>(y % part.ring_rows);
  }

  Chain pass_;
  const std::vector<StageSweep>& layout_;
  std::byte* scratch_;
  Range rows_;
  const StoredRows& input_;
  const StoredRows& output_;
  std::vector<int> next_row_;
};

void run_pass(Chain pass, const PassPlan& plan, const StoredRows& input, const StoredRows& output,
              Executor& executor, ScratchPool& scratch) {
  const Extent extent = pass.back()->extent();
  executor.parallel_for(plan.strips * plan.bands, [&](int task) {
    const int strip = task % plan.strips;
    const int band = task / plan.strips;
    const Range columns{strip * plan.strip_columns,
                        std::min((strip + 1) * plan.strip_columns, extent.columns)};
    const Range rows{band * plan.band_rows, std::min((band + 1) * plan.band_rows, extent.rows)};
    std::vector<StageSweep> layout;
    const std::size_t bytes = lay_out_sweep(pass, input.extent, columns, rows, layout);
    const ScratchPool::Lease lease = scratch.lease(std::max(bytes, plan.scratch_bytes));
    Sweep(pass, layout, lease.data(), rows, input, output).run();
  });
}

}  // namespace

void run_strips(Chain chain, const ChainPlan& plan, Executor& executor, ScratchPool& scratch) {
  StoredRows input;
  ScratchPool::Lease input_memory;
  for (const PassPlan& pass_plan : plan.passes) {
    const Chain pass =
        chain.subspan(static_cast<std::size_t>(pass_plan.first_stage),
                      static_cast<std::size_t>(pass_plan.end_stage - pass_plan.first_stage));
    StoredRows output;
    ScratchPool::Lease output_memory;
    if (const RowStage& last = *pass.back(); last.bytes_per_column() > 0) {
      output.extent = last.extent();
      output.row_bytes = last.bytes_per_column() * static_cast<std::size_t>(output.extent.columns);
      output_memory =
          scratch.lease(output.row_bytes * static_cast<std::size_t>(output.extent.rows));
      output.base = output_memory.data();
    }
    run_pass(pass, pass_plan, input, output, executor, scratch);
    input = output;
    input_memory = std::move(output_memory);
  }
}

}  // namespace vantage::scheduler
