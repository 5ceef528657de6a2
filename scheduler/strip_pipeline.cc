#include "scheduler/strip_pipeline.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "scheduler/sweep_layout.h"
#include "scheduler/trace.h"

namespace vantage::scheduler {
namespace {

/// The state between two passes: all its rows, or a ring of the newest ones.
struct StoredRows {
  std::byte* base = nullptr;
  std::size_t row_bytes = 0;
  int capacity_rows = 1;
  Range columns;

  [[nodiscard]] std::byte* row(int y) const {
    return base + row_bytes * static_cast<std::size_t>(y % capacity_rows);
  }
};

/// The sweep of one pass down one strip and band.
class Sweep {
 public:
  Sweep(const PassStages& pass, const SweepLayout& layout, std::byte* scratch, Range columns,
        Range rows, const StoredRows& input, const StoredRows& output, Span* traced)
      : pass_(pass),
        layout_(layout.parts),
        first_(pass.source == nullptr ? 0 : 1),
        last_(layout.parts.size() - 1),
        scratch_(scratch),
        columns_(columns),
        rows_(rows),
        input_(input),
        output_(output),
        traced_(traced),
        progress_(layout.parts.size()) {
    for (std::size_t k = 0; k <= last_; ++k) {
      progress_[k].next_row = layout_[k].first_row;
      progress_[k].window = window(k, layout_[k].first_row);
    }
  }

  /// The wavefront: a stage whose next row needs input that is not there yet lets the stage before
  /// it make that first. A loop, as a chain may be longer than a stack is deep.
  void run() {
    last_clock_ns_ = traced_ != nullptr ? trace_clock_ns() : 0;
    std::size_t k = last_;
    while (progress_[last_].next_row < rows_.end) {
      if (k > first_ && progress_[k - 1].next_row < progress_[k].window.end) {
        --k;
        continue;
      }
      if (first_ == 1 && layout_[k].reads_source) {
        while (progress_[0].next_row <= progress_[k].next_row) {
          make_row(0);
        }
      }
      make_row(k);
      k = std::min(k + 1, last_);
    }
    if (traced_ != nullptr) {
      for (std::size_t i = 0; i <= last_; ++i) {
        traced_->add_stage(share_of(i));
      }
    }
  }

 private:
  struct Progress {
    int next_row = 0;
    Range window;                  ///< rows of the input that it needs
    std::int64_t duration_ns = 0;  ///< only while traced
  };

  void make_row(std::size_t k) {
    Progress& progress = progress_[k];
    const StageSweep& part = layout_[k];
    const int y = progress.next_row;
    RowTask task;
    task.y = y;
    task.sweep_begins = y == part.first_row;
    task.columns = part.columns;
    task.state = scratch_ + part.state_offset;
    task.output = output_row(k, y);
    task.previous = task.sweep_begins ? nullptr : output_row(k, y - 1);
    if (k > first_) {
      task.input = ring(k - 1, progress.window);
    } else if (k == first_ && input_.base != nullptr) {
      task.input = {input_.base, input_.row_bytes, input_.capacity_rows, progress.window,
                    input_.columns};
    }
    if (part.reads_source) {
      task.source = ring(0, {y, y + 1});
    }
    part.stage->make_row(task);
    ++progress.next_row;
    progress.window = window(k, progress.next_row);
    if (traced_ != nullptr) {
      const std::int64_t now_ns = trace_clock_ns();
      progress.duration_ns += now_ns - std::exchange(last_clock_ns_, now_ns);
    }
  }

  [[nodiscard]] StageShare share_of(std::size_t k) const {
    const StageSweep& part = layout_[k];
    StageShare share;
    share.name = part.stage->name();
    share.duration_ns = progress_[k].duration_ns;
    share.rows = progress_[k].next_row - part.first_row;
    share.columns = static_cast<double>(share.rows) * part.columns.size();
    if (k >= first_) {  // else it is the source, made once more
      const auto area = [](Extent extent) {
        return static_cast<double>(extent.columns) * extent.rows;
      };
      share.own_columns = static_cast<double>(columns_.size()) * rows_.size() *
                          area(part.stage->extent()) / area(layout_[last_].stage->extent());
    }
    share.column_work = part.stage->column_work();
    return share;
  }

  [[nodiscard]] Range window(std::size_t k, int y) const {
    if (k < first_ || y >= layout_[k].stage->extent().rows) {
      return {};
    }
    return layout_[k].stage->input_rows(y,
                                        k > first_ ? layout_[k - 1].stage->extent() : pass_.input);
  }

  [[nodiscard]] InputRows ring(std::size_t k, Range rows) const {
    const StageSweep& part = layout_[k];
    return {scratch_ + part.ring_offset, part.row_bytes, part.ring_rows, rows, part.columns};
  }

  [[nodiscard]] std::byte* output_row(std::size_t k, int y) const {
    const StageSweep& part = layout_[k];
    // Rows that only warm up the state of a pass's last stage belong to another band: they go to
    // this task's own row.
    if (k == last_ && output_.base != nullptr && y >= rows_.begin) {
      return output_.row(y) +
             part.stage->bytes_per_column() * static_cast<std::size_t>(part.columns.begin);
    }
    return scratch_ + part.ring_offset +
           part.row_bytes * static_cast<std::size_t>(y % part.ring_rows);
  }

  const PassStages& pass_;
  const std::vector<StageSweep>& layout_;
  std::size_t first_;  ///< part that is the first stage of the pass
  std::size_t last_;
  std::byte* scratch_;
  Range columns_;
  Range rows_;
  const StoredRows& input_;
  const StoredRows& output_;
  Span* traced_;  ///< null unless a trace is recorded
  std::int64_t last_clock_ns_ = 0;
  std::vector<Progress> progress_;
};

/// Makes `rows` of the pass's output.
void run_pass(const PassStages& pass, const PassPlan& plan, Range rows, const StoredRows& input,
              const StoredRows& output, std::size_t scratch_bytes, int pass_number,
              Executor& executor, ScratchPool& scratch) {
  const int all_columns = pass.stages.back()->extent().columns;
  const int bands = (rows.size() + plan.band_rows - 1) / plan.band_rows;
  executor.parallel_for(plan.strips * bands, [&](int task) {
    const int strip = task % plan.strips;
    const int band_begin = rows.begin + task / plan.strips * plan.band_rows;
    const Range columns{strip * plan.strip_columns,
                        std::min((strip + 1) * plan.strip_columns, all_columns)};
    const Range band{band_begin, std::min(band_begin + plan.band_rows, rows.end)};
    SweepLayout layout;
    lay_out_sweep(pass, columns, band, layout);
    const ScratchPool::Lease lease =
        scratch.lease(std::max(layout.scratch_bytes, scratch_bytes), ScratchUse::kRings);
    Span* traced = Span::innermost();
    if (traced != nullptr) {
      traced->set_strip(pass_number, strip, band_begin);
    }
    Sweep(pass, layout, lease.data(), columns, band, input, output, traced).run();
  });
}

}  // namespace

void run_strips(Chain chain, const ChainPlan& plan, Executor& executor, ScratchPool& scratch) {
  struct PassRun {
    PassStages stages;
    StoredRows output;
    ScratchPool::Lease output_memory;
  };
  std::vector<PassRun> runs;
  std::size_t scratch_bytes = 0;  // one size for all passes, so that their tasks share leases
  for (const PassPlan& pass : plan.passes) {
    runs.push_back(
        {pass_stages(chain, pass.first_stage, pass.end_stage, pass.source_rows), {}, {}});
    scratch_bytes = std::max(scratch_bytes, pass.scratch_bytes);
  }
  for (int step = 0; step < plan.steps; ++step) {
    for (std::size_t p = 0; p < runs.size(); ++p) {
      const PassPlan& pass = plan.passes[p];
      PassRun& run = runs[p];
      const RowStage& last = *run.stages.stages.back();
      if (step == 0 && pass.stored_rows > 0) {
        const Extent extent = last.extent();
        run.output.row_bytes = last.bytes_per_column() * static_cast<std::size_t>(extent.columns);
        run.output.capacity_rows = pass.stored_rows;
        run.output.columns = extent.all_columns();
        run.output_memory = scratch.lease(
            run.output.row_bytes * static_cast<std::size_t>(pass.stored_rows), ScratchUse::kStored);
        run.output.base = run.output_memory.data();
      }
      const Range rows = rows_of_step(plan, pass, step, last.extent().rows);
      run_pass(run.stages, pass, rows, p == 0 ? StoredRows() : runs[p - 1].output, run.output,
               scratch_bytes, static_cast<int>(p), executor, scratch);
      if (p > 0 && step + 1 == plan.steps) {
        runs[p - 1].output_memory = {};  // so that whole images are no more than two at a time
      }
    }
  }
}

void run_regions(Chain chain, std::span<const Region> regions, Executor& executor,
                 ScratchPool& scratch) {
  const int stages = static_cast<int>(chain.size());
  const PassStages pass =
      pass_stages(chain, 0, stages, source_rows_to_keep(chain, row_reaches(chain), 0, stages));
  std::vector<SweepLayout> layouts(regions.size());
  std::size_t scratch_bytes = 0;  // one size, so that tasks share leases
  for (std::size_t i = 0; i < regions.size(); ++i) {
    lay_out_sweep(pass, regions[i].columns, regions[i].rows, layouts[i]);
    scratch_bytes = std::max(scratch_bytes, layouts[i].scratch_bytes);
  }
  executor.parallel_for(static_cast<int>(regions.size()), [&](int task) {
    const auto i = static_cast<std::size_t>(task);
    const ScratchPool::Lease lease = scratch.lease(scratch_bytes, ScratchUse::kRings);
    Span* traced = Span::innermost();
    if (traced != nullptr) {
      traced->set_strip(0, task, regions[i].rows.begin);
    }
    const StoredRows none;
    Sweep(pass, layouts[i], lease.data(), regions[i].columns, regions[i].rows, none, none, traced)
        .run();
  });
}

}  // namespace vantage::scheduler
