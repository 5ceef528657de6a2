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
namespace strip_pipeline_test {

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
    for (const int strip_columns : {1, 2, 7, 16, kAll}) {
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
                         testing::Values(kHashed, kDiffusion, kBoxes, kRunning, kAnchored, kScales,
                                         kSourceNext, kSourceTwice, kSourceEachTime,
                                         kSourceAfterSmoothing, kSourceAnchored),
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

TEST(StripPipelineSteps, EqualTheWholeImageAsTheCostModelChoosesThem) {
  const Extent extent{97, 61};
  TestChain chain(extent);
  kSourceEachTime.build(chain);
  chain.finish();
  const std::vector<std::byte> expected = whole_image_result(chain);
  Machine tiny;
  tiny.l1_data_bytes = 1024;
  tiny.l2_bytes = 64 * 1024;
  PlanRequest request;
  request.threads = 2;
  request.memory_bytes = 350 * 1024;  // a state is 370 KiB
  const ChainPlan plan = plan_chain(chain.stages(), tiny, request);
  ASSERT_GT(plan.passes.size(), 1U);
  ASSERT_GT(plan.steps, 1);
  for (const ExecutorCase& executor_case : executor_cases()) {
    const auto executor = executor_case.make();
    EXPECT_TRUE(strip_result(chain, plan, *executor) == expected) << executor_case.name;
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

// ---- Passes and steps.

class SourceReaders : public testing::TestWithParam<ChainCase> {};
INSTANTIATE_TEST_SUITE_P(Chains, SourceReaders,
                         testing::Values(kSourceNext, kSourceTwice, kSourceEachTime,
                                         kSourceAfterSmoothing, kSourceAnchored),
                         [](const auto& test) { return test.param.name; });

TEST_P(SourceReaders, MayBeCutIntoPassesAnywhere) {
  const auto executor = make_shuffled_executor(3);
  for (const Extent extent : {Extent{1, 1}, Extent{5, 2}, Extent{3, 19}, Extent{17, 13}}) {
    TestChain chain(extent);
    GetParam().build(chain);
    chain.finish();
    const std::vector<std::byte> expected = whole_image_result(chain);
    for (int first = 1; first < chain.size(); ++first) {
      for (int second = first; second < chain.size(); ++second) {
        std::vector<int> ends = {first};
        if (second > first) {
          ends.push_back(second);
        }
        const Cut cut{7, 5, ends};
        ASSERT_TRUE(strip_result(chain, plan_of(chain, cut), *executor) == expected)
            << describe(extent, cut, *executor) << ": " << first << ", " << second;
      }
    }
  }
}

bool fits(const ChainPlan& plan, const PlanRequest& request) {
  std::size_t scratch = 0;
  for (const PassPlan& pass : plan.passes) {
    scratch = std::max(scratch, pass.scratch_bytes);
  }
  return plan.stored_bytes + scratch * static_cast<std::size_t>(request.threads) <=
         request.memory_bytes.value_or(kDefaultMemoryBytes);
}

/// Chains that keep the number of rows: others have whole-image steps.
class StepsOfFewRows : public testing::TestWithParam<ChainCase> {};
INSTANTIATE_TEST_SUITE_P(Chains, StepsOfFewRows,
                         testing::Values(kHashed, kDiffusion, kBoxes, kRunning, kAnchored,
                                         kSourceNext, kSourceTwice, kSourceEachTime,
                                         kSourceAfterSmoothing, kSourceAnchored),
                         [](const auto& test) { return test.param.name; });

TEST_P(StepsOfFewRows, EqualTheWholeImageBitForBit) {
  const Extent extent{13, 61};
  TestChain chain(extent);
  GetParam().build(chain);
  chain.finish();
  const std::vector<std::byte> expected = whole_image_result(chain);
  std::vector<int> every;
  for (int stage = 1; stage < chain.size(); ++stage) {
    every.push_back(stage);
  }
  std::vector<std::unique_ptr<Executor>> executors;
  for (const ExecutorCase& executor_case : executor_cases()) {
    executors.push_back(executor_case.make());
  }
  std::size_t turn = 0;
  std::vector<std::vector<int>> splits = {every, {chain.size() / 2}};
  if (chain.size() > 3) {
    splits.push_back({1, chain.size() - 1});
  }
  for (const std::vector<int>& split : splits) {
    for (const int strip_columns : {4, kAll}) {
      const int band_rows = strip_columns == kAll ? kAll : 2;
      PlanRequest request;
      request.threads = 2;
      request.strip_columns = strip_columns;
      request.band_rows = band_rows;
      request.pass_ends = split;
      const ChainPlan whole = plan_chain(chain.stages(), Machine{}, request);
      ASSERT_EQ(whole.steps, 1);
      EXPECT_EQ(whole.step_rows, extent.rows);
      std::vector<int> all_step_rows;
      // From hardly too little to far too little.
      for (const double part : {0.999, 0.7, 0.4, 0.0}) {
        std::size_t scratch = 0;
        for (const PassPlan& pass : whole.passes) {
          scratch = std::max(scratch, pass.scratch_bytes);
        }
        request.memory_bytes =
            2 * scratch + static_cast<std::size_t>(part * static_cast<double>(whole.stored_bytes));
        const ChainPlan plan = plan_chain(chain.stages(), Machine{}, request);
        ASSERT_GT(plan.steps, 1);
        ASSERT_LT(plan.step_rows, extent.rows);
        EXPECT_TRUE(fits(plan, request) || plan.step_rows == 1);
        all_step_rows.push_back(plan.step_rows);
        Executor& executor = *executors[turn++ % executors.size()];
        ASSERT_TRUE(strip_result(chain, plan, executor) == expected)
            << describe(extent, {strip_columns, band_rows, split}, executor) << ", steps of "
            << plan.step_rows;
      }
      EXPECT_EQ(all_step_rows.back(), 1);
      EXPECT_TRUE(std::is_sorted(all_step_rows.rbegin(), all_step_rows.rend()));
    }
  }
}

TEST(StripPipelineSteps, StoredRowsStayWithinTheMemoryGiven) {
  const Extent extent{16, 211};
  TestChain chain(extent);
  kSourceEachTime.build(chain);
  chain.finish();
  const std::vector<std::byte> expected = whole_image_result(chain);
  const auto executor = make_executor(ExecutorKind::kSerial, 1);
  PlanRequest request;
  request.pass_ends = std::vector<int>{4, 8};
  request.strip_columns = 16;
  // Rows of 1 KiB: whole images are 2 · 211 KiB, the scratch of a strip about 30 KiB.
  for (const std::size_t memory_bytes : {400U << 10U, 200U << 10U, 100U << 10U, 80U << 10U}) {
    request.memory_bytes = memory_bytes;
    const ChainPlan plan = plan_chain(chain.stages(), Machine{}, request);
    EXPECT_GT(plan.steps, 1);
    ASSERT_TRUE(fits(plan, request)) << memory_bytes;
    ScratchPool pool;
    chain.sink().forget();
    run_strips(chain.stages(), plan, *executor, pool);
    EXPECT_TRUE(chain.sink().cells() == expected);
    EXPECT_LE(pool.bytes_held(), memory_bytes);
  }
}

TEST(StripPipelineSteps, ChainsThatChangeTheNumberOfRowsTakeWholeImages) {
  TestChain chain({29, 23});
  kScales.build(chain);
  chain.finish();
  const std::vector<std::byte> expected = whole_image_result(chain);
  const auto executor = make_executor(ExecutorKind::kSerial, 1);
  PlanRequest request;
  request.memory_bytes = 1000;
  for (int end = 1; end < chain.size(); ++end) {
    request.pass_ends = std::vector<int>{end};
    const ChainPlan plan = plan_chain(chain.stages(), Machine{}, request);
    // The last stages keep the size: they can be cut into steps whatever is before them.
    EXPECT_EQ(plan.steps == 1, end < chain.size() - 2) << end;
    EXPECT_TRUE(strip_result(chain, plan, *executor) == expected) << end;
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

/// Passes its input on a row late.
class Late final : public CellStage {
 public:
  explicit Late(Extent extent) : CellStage("late", extent) {}
  [[nodiscard]] Range input_rows(int y, Extent /*input*/) const override {
    return {std::max(0, y - 1), std::max(1, y)};
  }
  void make_row(const RowTask& /*task*/) const override {}
};

TEST(StripPipelineErrors, SourceCanOnlyBeReadOnItsOwnGrid) {
  const Extent extent{20, 12};
  const auto expect_refused = [](TestChain& chain, const std::string& why) {
    chain.finish();
    for (const bool whole_image : {true, false}) {
      try {
        if (whole_image) {
          run_whole_image(chain.stages());
        } else {
          plan_chain(chain.stages(), Machine{}, {});
        }
        ADD_FAILURE() << "expected an error: " << why;
      } catch (const std::logic_error& error) {
        EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
      }
    }
  };
  TestChain reads_itself(extent);
  reads_itself.add<PullToSource>(extent);
  expect_refused(reads_itself, "pull to source: is the source");

  TestChain smaller(extent);
  smaller.add<FloatSource>(extent);
  smaller.add<Reduction>(extent);
  smaller.add<PullToSource>(smaller.extent());
  expect_refused(smaller, "reduction: has another extent");

  TestChain there_and_back(extent);
  there_and_back.add<FloatSource>(extent);
  there_and_back.add<Reduction>(extent);
  there_and_back.add<Expansion>(extent);
  there_and_back.add<PullToSource>(extent);
  expect_refused(there_and_back, "reduction: has another extent");

  TestChain late(extent);
  late.add<FloatSource>(extent);
  late.add<Late>(extent);
  late.add<PullToSource>(extent);
  expect_refused(late, "late: does not look at the row");

  // Behind the last reader everything goes.
  TestChain sound(extent);
  sound.add<FloatSource>(extent);
  sound.add<PullToSource>(extent);
  sound.add<Reduction>(extent);
  sound.add<Late>(sound.extent());
  sound.finish();
  EXPECT_NO_THROW(plan_chain(sound.stages(), Machine{}, {}));
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

}  // namespace strip_pipeline_test
}  // namespace vantage::scheduler
