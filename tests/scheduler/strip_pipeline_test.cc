#include "scheduler/strip_pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scheduler/whole_image_pipeline.h"
#include "tests/scheduler/executor_cases.h"
#include "tests/scheduler/test_stages.h"

namespace vantage::scheduler {
namespace {

/// A chain of stages that ends in a sink, each under supervision.
class TestChain {
 public:
  explicit TestChain(Extent source) : extent_(source) {}

  template <typename Stage, typename... Arguments>
  void add(Arguments... arguments) {
    add(std::make_unique<Stage>(arguments...));
  }
  void add(std::unique_ptr<RowStage> stage) {
    const Extent input = stages_.empty() ? Extent{} : extent_;
    extent_ = stage->extent();
    stages_.push_back(std::move(stage));
    stages_.push_back(std::make_unique<Supervised>(*stages_.back(), input));
    chain_.push_back(stages_.back().get());
  }
  void finish() {
    auto sink = std::make_unique<Sink>(extent_);
    sink_ = sink.get();
    add(std::move(sink));
  }
  [[nodiscard]] Extent extent() const { return extent_; }
  [[nodiscard]] Chain stages() const { return chain_; }
  [[nodiscard]] int size() const { return static_cast<int>(chain_.size()); }
  [[nodiscard]] Sink& sink() const { return *sink_; }

 private:
  Extent extent_;
  std::vector<std::unique_ptr<RowStage>> stages_;
  std::vector<const RowStage*> chain_;
  Sink* sink_ = nullptr;
};

struct ChainCase {
  std::string name;
  std::function<void(TestChain&)> build;
};
std::ostream& operator<<(std::ostream& out, const ChainCase& c) { return out << c.name; }

const ChainCase kHashed{"hashed", [](TestChain& chain) { chain.add<FloatSource>(chain.extent()); }};
const ChainCase kDiffusion{"diffusion", [](TestChain& chain) {
                             chain.add<FloatSource>(chain.extent());
                             for (int iteration = 0; iteration < 10; ++iteration) {
                               chain.add<Diffusion>(chain.extent());
                             }
                           }};
const ChainCase kBoxes{"boxes", [](TestChain& chain) {
                         chain.add<FloatSource>(chain.extent());
                         for (const int radius : {1, 1, 1, 2}) {
                           chain.add<Box>(radius, chain.extent());
                         }
                       }};
const ChainCase kRunning{"running",
                         [](TestChain& chain) { chain.add<RunningSum>(2, chain.extent()); }};
const ChainCase kAnchored{"anchored", [](TestChain& chain) {
                            chain.add<FloatSource>(chain.extent());
                            chain.add<AnchoredSum>(3, chain.extent());
                            chain.add<Box>(1, chain.extent());
                            chain.add<AnchoredSum>(1, chain.extent());
                          }};
const ChainCase kScales{"scales", [](TestChain& chain) {
                          const Extent full = chain.extent();
                          chain.add<FloatSource>(full);
                          chain.add<Box>(1, full);
                          chain.add<Reduction>(full);
                          const Extent half = chain.extent();
                          chain.add<Diffusion>(half);
                          chain.add<Reduction>(half);
                          chain.add<AnchoredSum>(1, chain.extent());
                          chain.add<Expansion>(half);
                          chain.add<Diffusion>(half);
                          chain.add<Expansion>(full);
                          chain.add<Diffusion>(full);
                        }};

constexpr Extent kSizes[] = {{1, 1}, {1, 7}, {7, 1}, {13, 11}, {64, 3}, {97, 61}};
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

std::vector<std::byte> whole_image_result(const TestChain& chain) {
  chain.sink().forget();
  run_whole_image(chain.stages());
  EXPECT_TRUE(chain.sink().every_cell_came_once());
  return chain.sink().cells();
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
  constexpr double kMostCells = 3e6;
  std::size_t turn = 0;
  for (const Extent extent : kSizes) {
    TestChain chain(extent);
    GetParam().build(chain);
    chain.finish();
    const std::vector<std::byte> expected = whole_image_result(chain);
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
      // Small images with every executor, large ones with one after the other.
      const bool small = extent.columns * extent.rows < 50;
      for (std::size_t k = 0; k < (small ? executors.size() : 1); ++k) {
        Executor& executor = *executors[turn++ % executors.size()];
        ASSERT_TRUE(strip_result(chain, plan, executor) == expected)
            << describe(extent, cut, executor);
      }
    }
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

// ---- The whole-image oracle against plain loops over arrays.

using Plane = std::vector<float>;  // [y][x][lane]

std::size_t cell_index(Extent extent, int x, int y) {
  return (static_cast<std::size_t>(y) * static_cast<std::size_t>(extent.columns) +
          static_cast<std::size_t>(x)) *
         kCellLanes;
}

Plane hashed_plane(Extent extent) {
  Plane plane(cell_index(extent, 0, extent.rows));
  for (int y = 0; y < extent.rows; ++y) {
    for (int x = 0; x < extent.columns; ++x) {
      for (int i = 0; i < kCellLanes; ++i) {
        plane[cell_index(extent, x, y) + static_cast<std::size_t>(i)] = hashed_float(x, y, i);
      }
    }
  }
  return plane;
}

template <typename Value>
std::vector<Value> whole_image_values(const ChainCase& chain_case, Extent extent) {
  TestChain chain(extent);
  chain_case.build(chain);
  chain.finish();
  const std::vector<std::byte> cells = whole_image_result(chain);
  std::vector<Value> values(cells.size() / sizeof(Value));
  std::memcpy(values.data(), cells.data(), cells.size());
  return values;
}

TEST(WholeImagePipeline, DiffusesLikePlainLoops) {
  for (const Extent extent : kSizes) {
    Plane plane = hashed_plane(extent);
    for (int iteration = 0; iteration < 10; ++iteration) {
      Plane next = plane;
      for (int y = 0; y < extent.rows; ++y) {
        for (int x = 0; x < extent.columns; ++x) {
          for (std::size_t i = 0; i < kCellLanes; ++i) {
            const float centre = plane[cell_index(extent, x, y) + i];
            float sum = 0;
            for (const auto& [dx, dy] : {std::pair{0, -1}, {-1, 0}, {1, 0}, {0, 1}}) {
              if (x + dx >= 0 && x + dx < extent.columns && y + dy >= 0 && y + dy < extent.rows) {
                sum += plane[cell_index(extent, x + dx, y + dy) + i] - centre;
              }
            }
            next[cell_index(extent, x, y) + i] = centre + 0.15F * sum;
          }
        }
      }
      plane = next;
    }
    EXPECT_TRUE(whole_image_values<float>(kDiffusion, extent) == plane)
        << extent.columns << "x" << extent.rows;
  }
}

TEST(WholeImagePipeline, SumsRowsLikePlainLoops) {
  for (const Extent extent : kSizes) {
    std::vector<std::int32_t> sums(cell_index(extent, 0, extent.rows));
    for (int y = 0; y < extent.rows; ++y) {
      for (int x = 0; x < extent.columns; ++x) {
        for (int i = 0; i < kCellLanes; ++i) {
          for (int row = std::max(0, y - 2); row <= std::min(extent.rows - 1, y + 2); ++row) {
            sums[cell_index(extent, x, y) + static_cast<std::size_t>(i)] += hashed_int(x, row, i);
          }
        }
      }
    }
    EXPECT_EQ(whole_image_values<std::int32_t>(kRunning, extent), sums);
  }
}

TEST(WholeImagePipeline, SumsBoxesLikePlainLoops) {
  for (const Extent extent : kSizes) {
    Plane plane = hashed_plane(extent);
    for (const int radius : {1, 1, 1, 2}) {
      Plane next(plane.size(), 0.0F);
      for (int y = 0; y < extent.rows; ++y) {
        for (int x = 0; x < extent.columns; ++x) {
          for (int row = std::max(0, y - radius); row <= std::min(extent.rows - 1, y + radius);
               ++row) {
            for (int column = std::max(0, x - radius);
                 column <= std::min(extent.columns - 1, x + radius); ++column) {
              for (std::size_t i = 0; i < kCellLanes; ++i) {
                next[cell_index(extent, x, y) + i] += plane[cell_index(extent, column, row) + i];
              }
            }
          }
        }
      }
      plane = next;
    }
    EXPECT_TRUE(whole_image_values<float>(kBoxes, extent) == plane);
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
