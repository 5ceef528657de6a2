#pragma once

#include "scheduler/executor.h"
#include "scheduler/machine.h"
#include "scheduler/row_stage.h"
#include "scheduler/scratch_pool.h"
#include "scheduler/strip_pipeline.h"
#include "scheduler/strip_plan.h"
#include "scheduler/whole_image_pipeline.h"
#include "tests/engine/engine_test.h"
#include "tests/scheduler/test_stages.h"
#include "tests/test_sample.h"

namespace vantage::inline test {

/// The cells of an image, [y][x][lane].
template <typename Cell>
struct CellVolume {
  scheduler::Extent extent;
  int lanes = 0;
  std::vector<Cell> cells;

  CellVolume(scheduler::Extent grid, int lane_count)
      : extent(grid), lanes(lane_count), cells(index(0, grid.rows, 0)) {}
  [[nodiscard]] std::size_t index(int x, int y, int lane) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(extent.columns) +
            static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(lanes) +
           static_cast<std::size_t>(lane);
  }
  [[nodiscard]] const Cell& at(int x, int y, int lane) const { return cells[index(x, y, lane)]; }
  [[nodiscard]] Cell& at(int x, int y, int lane) { return cells[index(x, y, lane)]; }
};

/// A last stage that keeps what it gets in a volume, which must outlive it.
template <typename Cell>
class CellSink final : public scheduler::RowStage {
 public:
  explicit CellSink(CellVolume<Cell>& volume) : RowStage(volume.extent), volume_(volume) {}
  [[nodiscard]] std::string_view name() const override { return "cell sink"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  void make_row(const scheduler::RowTask& task) const override {
    const Cell* input =
        task.input.row<Cell>(task.y) +
        static_cast<std::ptrdiff_t>(task.columns.begin - task.input.columns().begin) *
            volume_.lanes;
    std::copy_n(input, volume_.index(task.columns.size(), 0, 0),
                &volume_.at(task.columns.begin, task.y, 0));
  }

 private:
  CellVolume<Cell>& volume_;
};

/// Runs `chain` in a sample of strips, bands and passes, on several executors, and calls check()
/// after each run.
template <typename Check>
void run_in_strips(scheduler::Chain chain, const Check& check) {
  using namespace scheduler;
  constexpr int kAll = 1 << 20;
  const int stages = static_cast<int>(chain.size());
  std::vector<std::vector<int>> splits = {{}};
  for (int end = 1; end < stages; ++end) {
    splits.push_back({end});
  }
  const std::unique_ptr<Executor> executors[] = {make_executor(ExecutorKind::kSerial, 1),
                                                 make_executor(ExecutorKind::kTbb, 2),
                                                 make_shuffled_executor(5)};
  constexpr int kStrips[] = {1, 3, 17, kAll};
  constexpr int kBands[] = {1, 5, kAll};
  for (const SampleRow& row : sampled_rows(
           {static_cast<int>(splits.size()), static_cast<int>(std::size(kStrips)),
            static_cast<int>(std::size(kBands)), static_cast<int>(std::size(executors))})) {
    PlanRequest request;
    request.pass_ends = splits[static_cast<std::size_t>(row[0])];
    request.strip_columns = kStrips[row[1]];
    request.band_rows = kBands[row[2]];
    SCOPED_TRACE(::testing::Message()
                 << "strips of " << *request.strip_columns << ", bands of " << *request.band_rows
                 << ", passes of " << ::testing::PrintToString(*request.pass_ends) << ", "
                 << sample_name());
    const ChainPlan plan = plan_chain(chain, Machine{}, request);
    ScratchPool pool;
    {
      // Memory that is not what a stage may hope for.
      const std::size_t bytes = std::max(plan.stored_bytes, plan.passes.front().scratch_bytes) + 64;
      std::memset(pool.lease(bytes).data(), 0xFD, bytes);
    }
    run_strips(chain, plan, *executors[row[3]], pool);
    check();
    if (::testing::Test::HasFatalFailure()) {
      return;
    }
  }
}

}  // namespace vantage::inline test
