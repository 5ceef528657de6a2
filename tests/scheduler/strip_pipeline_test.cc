#include "scheduler/strip_pipeline.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "tests/scheduler/executor_cases.h"
#include "tests/scheduler/test_chains.h"
#include "tests/test_sample.h"

namespace vantage::scheduler::strip_pipeline_test {

using vantage::test::sampled_rows;
using vantage::test::SampleRow;

constexpr int kAll = 1 << 20;

/// How one run cuts the image and the chain. What is not set the cost model chooses.
struct Cut {
  std::optional<int> strip_columns;
  std::optional<int> band_rows;
  std::optional<std::vector<int>> pass_ends;
};

ChainPlan plan_of(const TestChain& chain, const Cut& cut, int threads = 1) {
  PlanRequest request;
  request.threads = threads;
  request.strip_columns = cut.strip_columns;
  request.band_rows = cut.band_rows;
  request.pass_ends = cut.pass_ends;
  return plan_chain(chain.stages(), Machine{}, request);
}

const std::vector<int> kOnePass;

/// Leaves memory in the pool that is not what a stage may hope for.
void spoil(ScratchPool& pool, std::size_t bytes) {
  const ScratchPool::Lease lease = pool.lease(bytes);
  std::memset(lease.data(), 0xFD, bytes);
}

/// Of the pass that has most of it.
std::size_t scratch_bytes(const ChainPlan& plan) {
  return std::ranges::max_element(plan.passes, {}, &PassPlan::scratch_bytes)->scratch_bytes;
}

std::vector<std::byte> strip_result(const TestChain& chain, const ChainPlan& plan,
                                    Executor& executor) {
  ScratchPool pool;
  spoil(pool, std::max(plan.stored_bytes, scratch_bytes(plan)));
  chain.sink().forget();
  run_strips(chain.stages(), plan, executor, pool);
  EXPECT_TRUE(chain.sink().every_cell_came_once());
  return chain.sink().cells();
}

std::string describe(Extent extent, const Cut& cut, const Executor& executor) {
  const auto text = [](std::optional<int> value) {
    return value ? std::to_string(*value) : "chosen size";
  };
  return std::to_string(extent.columns) + "x" + std::to_string(extent.rows) + ", strips of " +
         text(cut.strip_columns) + ", bands of " + text(cut.band_rows) +
         ", passes: " + (cut.pass_ends ? std::to_string(cut.pass_ends->size() + 1) : "chosen") +
         ", " + std::string(executor.name()) + " with " + std::to_string(executor.thread_count()) +
         " threads, " + test::sample_name();
}

const std::vector<ChainCase> kChains = {
    kHashed,        kDiffusion,  kBoxes,       kRunning,        kAnchored,
    kScales,        kSourceNext, kSourceTwice, kSourceEachTime, kSourceAfterSmoothing,
    kSourceAnchored};

// Dimensions of the sample of ways to cut chains and to run them.
constexpr Extent kExtents[] = {{1, 1}, {1, 7}, {7, 1}, {13, 11}, {64, 3}, {29, 23}, {97, 61}};
constexpr std::optional<int> kStrips[] = {1, 2, 7, 16, kAll, std::nullopt};
constexpr std::optional<int> kBands[] = {1, 3, 6, kAll, std::nullopt};
constexpr int kSplits = 5;

std::vector<int> behind_every_stage(const TestChain& chain) {
  std::vector<int> ends(static_cast<std::size_t>(chain.size()) - 1);
  std::iota(ends.begin(), ends.end(), 1);
  return ends;
}

/// Nowhere, half way, behind every stage, before the last, where the cost model wants it.
std::optional<std::vector<int>> split_of(const TestChain& chain, int split) {
  switch (split) {
    case 0:
      return std::vector<int>{};
    case 1:
      return std::vector<int>{std::max(1, chain.size() / 2)};
    case 2:
      return behind_every_stage(chain);
    case 3:
      return std::vector<int>{chain.size() - 1};
    default:
      return std::nullopt;
  }
}

/// A row of the sample: chain; strip and band together, as it is their corners that halos and
/// starting rows meet in; extent; split; executor.
class CutSample {
 public:
  static const std::vector<SampleRow>& rows() {
    static const std::vector<SampleRow> rows = CutSample().draw();
    return rows;
  }
  static Cut cut_of(const TestChain& chain, const SampleRow& row) {
    const auto size = static_cast<int>(std::size(kBands));
    return {kStrips[row[1] / size], kBands[row[1] % size], split_of(chain, row[3])};
  }

 private:
  std::vector<SampleRow> draw() {
    return sampled_rows(
        {static_cast<int>(kChains.size()), static_cast<int>(std::size(kStrips) * std::size(kBands)),
         static_cast<int>(std::size(kExtents)), kSplits, static_cast<int>(executor_cases().size())},
        [this](const SampleRow& row) { return is_cheap(row); });
  }
  /// Many cells (halo cells counted) are left to smaller images.
  bool is_cheap(const SampleRow& row) {
    constexpr double kMaxCells = 1e5;
    const Extent extent = kExtents[row[2]];
    auto [known, is_new] = known_.try_emplace({row[0], row[1], row[2], row[3]}, false);
    if (is_new) {
      const TestChain chain(extent, kChains[row[0]]);
      double cells = 0;
      for (const PassPlan& pass : plan_of(chain, cut_of(chain, row)).passes) {
        cells +=
            pass.work_ratio * (pass.end_stage - pass.first_stage) * extent.columns * extent.rows;
      }
      known->second = cells <= kMaxCells;
    }
    return known->second;
  }
  std::map<std::array<int, 4>, bool> known_;
};

class StripPipeline : public testing::TestWithParam<int> {
 protected:
  static const ChainCase& chain_case() { return kChains[GetParam()]; }
};
INSTANTIATE_TEST_SUITE_P(Chains, StripPipeline, testing::Range(0, static_cast<int>(kChains.size())),
                         [](const auto& test) { return kChains[test.param].name; });

TEST_P(StripPipeline, EqualsTheWholeImageBitForBit) {
  const std::vector<ExecutorCase> executors = executor_cases();
  std::map<int, std::pair<std::unique_ptr<TestChain>, std::vector<std::byte>>> chains;
  for (const SampleRow& row : test::rows_of(CutSample::rows(), GetParam())) {
    auto& [chain, expected] = chains[row[2]];
    if (chain == nullptr) {
      chain = std::make_unique<TestChain>(kExtents[row[2]], chain_case());
      expected = whole_image_result(*chain);
    }
    const Cut cut = CutSample::cut_of(*chain, row);
    const ExecutorCase& executor_case = executors[row[4]];
    const auto executor = executor_case.make();
    const ChainPlan plan = plan_of(*chain, cut, executor_case.threads);
    ASSERT_TRUE(strip_result(*chain, plan, *executor) == expected)
        << describe(kExtents[row[2]], cut, *executor);
  }
}

TEST(StripPipelineSteps, EqualTheWholeImageAsTheCostModelChoosesThem) {
  const Extent extent{97, 61};
  TestChain chain(extent, kSourceEachTime);
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
  const TestChain chain({40, 20}, chain_case());
  const auto executor = make_executor(ExecutorKind::kSerial, 1);
  for (const Cut& cut : {Cut{9, 6, kOnePass}, Cut{9, 6, std::vector<int>{1}}}) {
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
    TestChain chain(extent, GetParam());
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
  return plan.stored_bytes + scratch_bytes(plan) * static_cast<std::size_t>(request.threads) <=
         request.memory_bytes.value_or(kDefaultMemoryBytes);
}

/// Chains that keep the number of rows: others have whole-image steps.
const std::vector<ChainCase> kStepChains = {kHashed,        kDiffusion,      kBoxes,
                                            kRunning,       kAnchored,       kSourceNext,
                                            kSourceTwice,   kSourceEachTime, kSourceAfterSmoothing,
                                            kSourceAnchored};
/// Memory for steps, of what whole images take: from hardly too little to far too little.
constexpr double kParts[] = {0.999, 0.7, 0.4, 0.0};

/// Which chains, splits, strips and parts of the memory are not only planned but run.
const std::vector<SampleRow>& steps_to_run() {
  static const std::vector<SampleRow> rows = sampled_rows(
      {static_cast<int>(kStepChains.size()), 3, 2, static_cast<int>(std::size(kParts))});
  return rows;
}

class StepsOfFewRows : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Chains, StepsOfFewRows,
                         testing::Range(0, static_cast<int>(kStepChains.size())),
                         [](const auto& test) { return kStepChains[test.param].name; });

TEST_P(StepsOfFewRows, EqualTheWholeImageBitForBit) {
  const Extent extent{13, 41};
  const TestChain chain(extent, kStepChains[GetParam()]);
  const std::vector<std::byte> expected = whole_image_result(chain);
  const std::vector<ExecutorCase> executors = executor_cases();
  std::vector<std::vector<int>> splits = {behind_every_stage(chain), {chain.size() / 2}};
  if (chain.size() > 3) {
    splits.push_back({1, chain.size() - 1});
  }
  for (int s = 0; s < static_cast<int>(splits.size()); ++s) {
    const std::vector<int>& split = splits[s];
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
      for (int part = 0; part < static_cast<int>(std::size(kParts)); ++part) {
        request.memory_bytes =
            2 * scratch_bytes(whole) +
            static_cast<std::size_t>(kParts[part] * static_cast<double>(whole.stored_bytes));
        const ChainPlan plan = plan_chain(chain.stages(), Machine{}, request);
        ASSERT_GT(plan.steps, 1);
        ASSERT_LT(plan.step_rows, extent.rows);
        EXPECT_TRUE(fits(plan, request) || plan.step_rows == 1);
        all_step_rows.push_back(plan.step_rows);
        const SampleRow row = {GetParam(), s, strip_columns == kAll ? 1 : 0, part};
        const auto place = std::ranges::find(steps_to_run(), row);
        if (place == steps_to_run().end()) {
          continue;
        }
        // One executor after the other.
        const auto turn = static_cast<std::size_t>(place - steps_to_run().begin());
        const auto executor = executors[turn % executors.size()].make();
        ASSERT_TRUE(strip_result(chain, plan, *executor) == expected)
            << describe(extent, {strip_columns, band_rows, split}, *executor) << ", steps of "
            << plan.step_rows;
      }
      EXPECT_EQ(all_step_rows.back(), 1);
      EXPECT_TRUE(std::is_sorted(all_step_rows.rbegin(), all_step_rows.rend()));
    }
  }
}

TEST(StripPipelineSteps, StoredRowsStayWithinTheMemoryGiven) {
  const Extent extent{16, 211};
  TestChain chain(extent, kSourceEachTime);
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
  TestChain chain({29, 23}, kScales);
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
      for (const Cut& cut : {Cut{3, 2, kOnePass}, Cut{kAll, kAll, std::vector<int>{2}},
                             Cut{6, kAll, std::vector<int>{1, 3}}}) {
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
  const ChainPlan plan =
      plan_of(chain, {2, SpoilsRowsBeforeTheBand::kBandRows, std::vector<int>{2}});
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
  EXPECT_FALSE(depends_on<CountsFromTheStrip>({kAll, 3, kOnePass}));
  EXPECT_TRUE(depends_on<CountsFromTheStrip>({16, kAll, kOnePass}));
  EXPECT_FALSE(depends_on<RoundsFromTheBand>({5, kAll, kOnePass}));
  EXPECT_TRUE(depends_on<RoundsFromTheBand>({kAll, 3, kOnePass}));
  EXPECT_TRUE(depends_on<LooksTooFar>({kAll, kAll, kOnePass}));
}

}  // namespace vantage::scheduler::strip_pipeline_test
