#include "scheduler/strip_pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/scheduler/executor_cases.h"
#include "tests/scheduler/test_chains.h"
#include "tests/scheduler/test_stages.h"

namespace vantage::scheduler {
namespace {

constexpr int kAll = 1 << 20;

/// How one run cuts the image and the chain.
struct Cut {
  int strip_columns;
  int band_rows;
  std::vector<int> pass_ends;
};

std::vector<Cut> cuts_of(const TestChain& chain) {
  std::vector<std::vector<int>> splits = {{}};
  if (chain.size() > 2) {
    splits.push_back({chain.size() / 2});
  }
  std::vector<int> every;
  for (int stage = 1; stage < chain.size(); ++stage) {
    every.push_back(stage);
  }
  splits.push_back(every);
  std::vector<Cut> cuts;
  for (const std::vector<int>& split : splits) {
    for (const int strip_columns : {1, 2, 5, 16, kAll}) {
      for (const int band_rows : {1, 3, kAll}) {
        cuts.push_back({strip_columns, band_rows, split});
      }
    }
  }
  return cuts;
}

ChainPlan plan_of(const TestChain& chain, const Cut& cut) {
  PlanRequest request;
  request.strip_columns = cut.strip_columns;
  request.band_rows = cut.band_rows;
  request.pass_ends = cut.pass_ends;
  return plan_chain(chain.stages(), Machine{}, request);
}

/// Leaves memory in the pool that is not what a stage may hope for.
void spoil(ScratchPool& pool, std::size_t bytes) {
  const ScratchPool::Lease lease = pool.lease(bytes);
  std::memset(lease.data(), 0xFD, bytes);
}

std::size_t spoilt_bytes(const ChainPlan& plan) {
  std::size_t bytes = plan.stored_bytes;
  for (const PassPlan& pass : plan.passes) {
    bytes = std::max(bytes, pass.scratch_bytes);
  }
  return bytes;
}

std::vector<std::byte> strip_result(const TestChain& chain, const ChainPlan& plan,
                                    Executor& executor) {
  ScratchPool pool;
  spoil(pool, spoilt_bytes(plan));
  chain.sink().forget();
  run_strips(chain.stages(), plan, executor, pool);
  EXPECT_TRUE(chain.sink().every_cell_came_once());
  return chain.sink().cells();
}

std::string describe(Extent extent, const Cut& cut, const Executor& executor) {
  return std::to_string(extent.columns) + "x" + std::to_string(extent.rows) + ", strips of " +
         std::to_string(cut.strip_columns) + ", bands of " + std::to_string(cut.band_rows) + ", " +
         std::to_string(cut.pass_ends.size() + 1) + " passes, " + std::string(executor.name()) +
         " with " + std::to_string(executor.thread_count()) + " threads";
}

class StripPipeline : public testing::TestWithParam<ChainCase> {};
INSTANTIATE_TEST_SUITE_P(Chains, StripPipeline,
                         testing::Values(kHashed, kDiffusion, kBoxes, kRunning, kAnchored, kScales),
                         [](const auto& test) { return test.param.name; });

TEST_P(StripPipeline, EqualsTheWholeImageBitForBit) {
  std::vector<std::unique_ptr<Executor>> executors;
  for (const ExecutorCase& executor_case : executor_cases()) {
    executors.push_back(executor_case.make());
  }
  // More cells than this (halo cells counted) are left to smaller images.
  constexpr double kMostCells = 3e5;
  std::size_t turn = 0;
  for (const Extent extent : kSizes) {
    TestChain chain(extent);
    GetParam().build(chain);
    chain.finish();
    const std::vector<std::byte> expected = whole_image_result(chain);
    int cuts_run = 0;
    for (const Cut& cut : cuts_of(chain)) {
      const ChainPlan plan = plan_of(chain, cut);
      double cells = 0;
      for (const PassPlan& pass : plan.passes) {
        cells +=
            pass.work_ratio * (pass.end_stage - pass.first_stage) * extent.columns * extent.rows;
      }
      if (cells > kMostCells) {
        continue;
      }
      ++cuts_run;
      // Small images with every executor, large ones with one after the other.
      const bool small = extent.columns * extent.rows < 50;
      for (std::size_t k = 0; k < (small ? executors.size() : 1); ++k) {
        Executor& executor = *executors[turn++ % executors.size()];
        ASSERT_TRUE(strip_result(chain, plan, executor) == expected)
            << describe(extent, cut, executor);
      }
    }
    EXPECT_GE(cuts_run, 15) << extent.columns << "x" << extent.rows;
  }
}

TEST_P(StripPipeline, EqualsTheWholeImageOnEveryExecutor) {
  const Extent extent{29, 23};
  TestChain chain(extent);
  GetParam().build(chain);
  chain.finish();
  const std::vector<std::byte> expected = whole_image_result(chain);
  for (const ExecutorCase& executor_case : executor_cases()) {
    const auto executor = executor_case.make();
    for (const Cut& cut : {Cut{4, 5, {}}, Cut{7, 6, {chain.size() - 1}}}) {
      ASSERT_TRUE(strip_result(chain, plan_of(chain, cut), *executor) == expected)
          << describe(extent, cut, *executor);
    }
    PlanRequest request;
    request.threads = executor_case.threads;
    ASSERT_TRUE(strip_result(chain, plan_chain(chain.stages(), Machine{}, request), *executor) ==
                expected)
        << "by the cost model, " << executor_case.name;
  }
}

TEST_P(StripPipeline, AllocatesNothingInSteadyState) {
  TestChain chain({40, 20});
  GetParam().build(chain);
  chain.finish();
  const auto executor = make_executor(ExecutorKind::kSerial, 1);
  for (const Cut& cut : {Cut{9, 6, {}}, Cut{9, 6, {1}}}) {
    const ChainPlan plan = plan_of(chain, cut);
    ScratchPool pool;
    run_strips(chain.stages(), plan, *executor, pool);
    run_strips(chain.stages(), plan, *executor, pool);
    const std::size_t held = pool.bytes_held();
    for (int run = 0; run < 4; ++run) {
      run_strips(chain.stages(), plan, *executor, pool);
      ASSERT_EQ(pool.bytes_held(), held);
    }
  }
}

// ---- Errors.

/// Fails at one row.
class Failing final : public CellStage {
 public:
  Failing(int row, Extent extent) : CellStage("failing", extent), row_(row) {}
  void make_row(const RowTask& task) const override {
    if (task.y == row_) {
      throw std::runtime_error("row " + std::to_string(task.y));
    }
    std::memcpy(
        task.output,
        task.input.row<FloatCell>(task.y) + (task.columns.begin - task.input.columns().begin),
        sizeof(FloatCell) * static_cast<std::size_t>(task.columns.size()));
  }

 private:
  int row_;
};

TEST(StripPipelineErrors, ErrorOfAStageArrivesAndTheExecutorGoesOn) {
  const Extent extent{20, 12};
  for (const ExecutorCase& executor_case : executor_cases()) {
    const auto executor = executor_case.make();
    ScratchPool pool;
    for (const int row : {0, 5, 11, -1}) {
      TestChain chain(extent);
      chain.add<FloatSource>(extent);
      chain.add<Failing>(row, extent);
      chain.add<Diffusion>(extent);
      chain.finish();
      for (const Cut& cut : {Cut{3, 2, {}}, Cut{kAll, kAll, {2}}, Cut{6, kAll, {1, 3}}}) {
        chain.sink().forget();
        try {
          run_strips(chain.stages(), plan_of(chain, cut), *executor, pool);
          EXPECT_EQ(row, -1) << "no error arrived";
          EXPECT_TRUE(chain.sink().every_cell_came_once());
        } catch (const std::runtime_error& error) {
          EXPECT_EQ(error.what(), "row " + std::to_string(row)) << executor_case.name;
        }
      }
    }
  }
}

// ---- Rows before the band.

/// Copies its input, but rows that only bring it from an anchor to the first row of a band of
/// kBandRows rows come out as −1. Anchors tell the bands apart: 0, 8, 24, 32 for 0, 12, 24, 36.
class SpoilsRowsBeforeTheBand final : public CellStage {
 public:
  static constexpr int kBandRows = 12;
  explicit SpoilsRowsBeforeTheBand(Extent extent) : CellStage("spoils rows", extent) {}
  [[nodiscard]] int sweep_start(int y) const override { return y / 8 * 8; }
  [[nodiscard]] std::size_t state_bytes(Range /*columns*/, Extent /*input*/) const override {
    return sizeof(int);
  }
  void make_row(const RowTask& task) const override {
    if (task.sweep_begins) {
      std::memcpy(task.state, &task.y, sizeof(int));
    }
    int start = 0;
    std::memcpy(&start, task.state, sizeof(int));
    const bool before_the_band = start % kBandRows == 8 && task.y < start + 4;
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      for (int i = 0; i < kCellLanes; ++i) {
        out<FloatCell>(task, x)[i] = before_the_band ? -1.0F : in<FloatCell>(task, x, task.y)[i];
      }
    }
  }
};

TEST(StripPipelineBands, RowsThatOnlyWarmUpLeaveOtherBandsAlone) {
  const Extent extent{5, 40};
  TestChain chain(extent);
  chain.add<FloatSource>(extent);
  chain.add<SpoilsRowsBeforeTheBand>(extent);
  chain.finish();
  const std::vector<std::byte> expected = whole_image_result(chain);
  const ChainPlan plan = plan_of(chain, {2, SpoilsRowsBeforeTheBand::kBandRows, {2}});
  for (const ExecutorCase& executor_case : executor_cases()) {
    const auto executor = executor_case.make();
    EXPECT_TRUE(strip_result(chain, plan, *executor) == expected) << executor_case.name;
  }
}

// ---- Tests of the test: stages that break the rules of RowStage must be found.

/// Adds cells up from the first column it is asked for.
class CountsFromTheStrip final : public CellStage {
 public:
  explicit CountsFromTheStrip(Extent extent) : CellStage("counts from the strip", extent) {}
  void make_row(const RowTask& task) const override {
    FloatCell sum = {};
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      for (int i = 0; i < kCellLanes; ++i) {
        sum[i] += in<FloatCell>(task, x, task.y)[i];
        out<FloatCell>(task, x)[i] = sum[i];
      }
    }
  }
};

/// Moves a sum of floats from row to row without anchors.
class RoundsFromTheBand final : public CellStage {
 public:
  explicit RoundsFromTheBand(Extent extent) : CellStage("rounds from the band", extent) {}
  void make_row(const RowTask& task) const override {
    const auto* previous = reinterpret_cast<const FloatCell*>(task.previous);
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      for (int i = 0; i < kCellLanes; ++i) {
        const float value = in<FloatCell>(task, x, task.y)[i];
        out<FloatCell>(task, x)[i] =
            task.sweep_begins ? value : previous[x - task.columns.begin][i] * 0.5F + value;
      }
    }
  }
};

/// Looks at one row more than it says.
class LooksTooFar final : public CellStage {
 public:
  explicit LooksTooFar(Extent extent) : CellStage("looks too far", extent) {}
  void make_row(const RowTask& task) const override {
    const int y = std::max(0, task.y - 1);
    for (int x = task.columns.begin; x < task.columns.end; ++x) {
      for (int i = 0; i < kCellLanes; ++i) {
        out<FloatCell>(task, x)[i] = in<FloatCell>(task, x, y)[i];
      }
    }
  }
};

template <typename Stage>
bool depends_on(const Cut& cut) {
  const Extent extent{20, 12};
  TestChain chain(extent);
  chain.add<FloatSource>(extent);
  chain.add<Stage>(extent);
  chain.finish();
  const auto executor = make_executor(ExecutorKind::kSerial, 1);
  const std::vector<std::byte> expected = whole_image_result(chain);
  return strip_result(chain, plan_of(chain, cut), *executor) != expected;
}

TEST(StripPipelineTest, FindsStagesThatDependOnTheCut) {
  EXPECT_FALSE(depends_on<CountsFromTheStrip>({kAll, 3, {}}));
  EXPECT_TRUE(depends_on<CountsFromTheStrip>({16, kAll, {}}));
  EXPECT_FALSE(depends_on<RoundsFromTheBand>({5, kAll, {}}));
  EXPECT_TRUE(depends_on<RoundsFromTheBand>({kAll, 3, {}}));
  EXPECT_TRUE(depends_on<LooksTooFar>({kAll, kAll, {}}));
}

}  // namespace
}  // namespace vantage::scheduler
