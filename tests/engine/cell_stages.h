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

namespace vantage {
inline namespace test {

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

/// Multiples of 1/8 in [least, least + 100].
inline CellVolume<float> random_cells(scheduler::Extent extent, int lanes, float min,
                                      std::uint32_t seed) {
  std::mt19937 random(seed);
  CellVolume<float> volume(extent, lanes);
  for (float& cell : volume.cells) {
    cell = min + static_cast<float>(random() % 801U) / 8;
  }
  return volume;
}

/// A source stage that makes the cells of a volume, which must outlive it.
class CellSource final : public scheduler::RowStage {
 public:
  explicit CellSource(const CellVolume<float>& volume) : RowStage(volume.extent), volume_(volume) {}
  [[nodiscard]] std::string_view name() const override { return "cell source"; }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return sizeof(float) * static_cast<std::size_t>(volume_.lanes);
  }
  void make_row(const scheduler::RowTask& task) const override {
    std::memcpy(task.output, &volume_.at(task.columns.begin, task.y, 0),
                bytes_per_column() * static_cast<std::size_t>(task.columns.size()));
  }

 private:
  const CellVolume<float>& volume_;
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

/// Passes another stage on and shows it no more of its input than it asks for.
class DeclaredInputOnly final : public scheduler::RowStage {
 public:
  DeclaredInputOnly(const scheduler::RowStage& inner, scheduler::Extent input,
                    std::size_t input_bytes_per_column)
      : RowStage(inner.extent()),
        inner_(inner),
        input_(input),
        input_bytes_per_column_(input_bytes_per_column) {}
  [[nodiscard]] std::string_view name() const override { return inner_.name(); }
  [[nodiscard]] std::size_t bytes_per_column() const override { return inner_.bytes_per_column(); }
  [[nodiscard]] scheduler::Range input_rows(int y, scheduler::Extent input) const override {
    return inner_.input_rows(y, input);
  }
  [[nodiscard]] scheduler::Range input_columns(scheduler::Range columns,
                                               scheduler::Extent input) const override {
    return inner_.input_columns(columns, input);
  }
  [[nodiscard]] int window_rows() const override { return inner_.window_rows(); }
  [[nodiscard]] int first_row_work() const override { return inner_.first_row_work(); }
  [[nodiscard]] int sweep_start(int y) const override { return inner_.sweep_start(y); }
  [[nodiscard]] std::size_t state_bytes(scheduler::Range columns,
                                        scheduler::Extent input) const override {
    return inner_.state_bytes(columns, input);
  }
  void make_row(const scheduler::RowTask& task) const override {
    const scheduler::Range rows = inner_.input_rows(task.y, input_);
    const scheduler::Range columns = inner_.input_columns(task.columns, input_);
    const int capacity_rows = rows.size() + 1;  // a row that is not asked for has its own place
    const std::size_t row_bytes =
        (input_bytes_per_column_ * static_cast<std::size_t>(columns.size()) + 63) / 64 * 64;
    scheduler::ScratchPool pool;
    const scheduler::ScratchPool::Lease memory =
        pool.lease(row_bytes * static_cast<std::size_t>(capacity_rows));
    std::memset(memory.data(), 0xFD, row_bytes * static_cast<std::size_t>(capacity_rows));
    for (int y = rows.begin; y < rows.end; ++y) {
      std::memcpy(memory.data() + row_bytes * static_cast<std::size_t>(y % capacity_rows),
                  task.input.row<std::byte>(y) +
                      input_bytes_per_column_ *
                          static_cast<std::size_t>(columns.begin - task.input.columns().begin),
                  input_bytes_per_column_ * static_cast<std::size_t>(columns.size()));
    }
    scheduler::RowTask frugal = task;
    frugal.input = {memory.data(), row_bytes, capacity_rows, rows, columns};
    inner_.make_row(frugal);
  }

 private:
  const scheduler::RowStage& inner_;
  scheduler::Extent input_;
  std::size_t input_bytes_per_column_;
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

/// What `stages` make of `input`, from the plain executor; expects the same bits from all others.
template <typename Output>
CellVolume<Output> run_every_way(const CellVolume<float>& input,
                                 std::span<const std::unique_ptr<scheduler::RowStage>> stages) {
  CellVolume<Output> output(input.extent, input.lanes);
  const CellSource source(input);
  const CellSink<Output> sink(output);
  std::vector<std::unique_ptr<scheduler::RowStage>> wrappers;
  std::vector<const scheduler::RowStage*> chain = {&source};
  for (const auto& stage : stages) {
    wrappers.push_back(std::make_unique<DeclaredInputOnly>(*stage, input.extent,
                                                           chain.back()->bytes_per_column()));
    wrappers.push_back(std::make_unique<scheduler::Supervised>(*wrappers.back(), input.extent));
    chain.push_back(wrappers.back().get());
  }
  chain.push_back(&sink);
  scheduler::run_whole_image(chain);
  const CellVolume<Output> expected = output;
  run_in_strips(chain, [&] {
    ASSERT_EQ(std::memcmp(output.cells.data(), expected.cells.data(),
                          sizeof(Output) * output.cells.size()),
              0);
    std::memset(output.cells.data(), 0xFD, sizeof(Output) * output.cells.size());
  });
  return expected;
}

}  // namespace test
}  // namespace vantage
