#include "scheduler/strip_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "scheduler/machine.h"
#include "scheduler/sweep_layout.h"

namespace vantage::scheduler::strip_plan_test {

/// A stage that is all geometry: `halo` rows and columns around each cell.
class Geometry final : public RowStage {
 public:
  Geometry(Extent extent, int halo, std::size_t bytes_per_column, int first_row_work = 1,
           bool reads_source = false)
      : RowStage(extent),
        halo_(halo),
        bytes_per_column_(bytes_per_column),
        first_row_work_(first_row_work),
        reads_source_(reads_source) {}
  [[nodiscard]] std::string_view name() const override { return "geometry"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return bytes_per_column_; }
  [[nodiscard]] Range input_rows(int y, Extent input) const override {
    return Range{y, y + 1}.widened(halo_, input.all_rows());
  }
  [[nodiscard]] Range input_columns(Range columns, Extent input) const override {
    return columns.widened(halo_, input.all_columns());
  }
  [[nodiscard]] int window_rows() const override { return 2 * halo_ + 1; }
  [[nodiscard]] int first_row_work() const override { return first_row_work_; }
  [[nodiscard]] bool reads_source() const override { return reads_source_; }
  [[nodiscard]] std::size_t state_bytes(Range columns, Extent /*input*/) const override {
    return static_cast<std::size_t>(columns.size());
  }
  void make_row(const RowTask& /*task*/) const override {}

 private:
  int halo_;
  std::size_t bytes_per_column_;
  int first_row_work_;
  bool reads_source_;
};

/// A source, `steps` stages with `halo`, and a last stage without output.
class GeometryChain {
 public:
  GeometryChain(Extent extent, int steps, int halo, std::size_t bytes_per_column = 256,
                int first_row_work = 1, bool steps_read_source = false) {
    add(extent, 0, bytes_per_column, first_row_work, false);
    for (int step = 0; step < steps; ++step) {
      add(extent, halo, bytes_per_column, 1, steps_read_source);
    }
    add(extent, 0, 0, 1, false);
  }
  [[nodiscard]] Chain stages() const { return chain_; }
  [[nodiscard]] int size() const { return static_cast<int>(chain_.size()); }

 private:
  void add(Extent extent, int halo, std::size_t bytes_per_column, int first_row_work,
           bool reads_source) {
    stages_.push_back(
        std::make_unique<Geometry>(extent, halo, bytes_per_column, first_row_work, reads_source));
    chain_.push_back(stages_.back().get());
  }
  std::vector<std::unique_ptr<Geometry>> stages_;
  std::vector<const RowStage*> chain_;
};

/// Iterations of a diffusion that also look at the matching cost.
GeometryChain iterations(Extent extent, int count, std::size_t bytes_per_column) {
  return {extent, count, 1, bytes_per_column, 1, true};
}

/// Of the pass that has most of it.
std::size_t scratch_bytes(const ChainPlan& plan) {
  return std::ranges::max_element(plan.passes, {}, &PassPlan::scratch_bytes)->scratch_bytes;
}

std::size_t bytes_taken(const ChainPlan& plan, int threads) {
  return plan.stored_bytes + scratch_bytes(plan) * static_cast<std::size_t>(threads);
}

double expected_time(const ChainPlan& plan) {
  double time = 0;
  for (const PassPlan& pass : plan.passes) {
    time += pass.expected_time;
  }
  return time;
}

/// Passes follow each other through the chain; each cuts its grid into parts that cover it once.
void expect_sound(const ChainPlan& plan, Chain chain) {
  ASSERT_FALSE(plan.passes.empty());
  int next_stage = 0;
  for (const PassPlan& pass : plan.passes) {
    EXPECT_EQ(pass.first_stage, next_stage);
    EXPECT_GT(pass.end_stage, pass.first_stage);
    next_stage = pass.end_stage;
    const Extent extent = chain[static_cast<std::size_t>(pass.end_stage) - 1]->extent();
    EXPECT_GE(pass.strip_columns, 1);
    EXPECT_GE(pass.band_rows, 1);
    EXPECT_LE(pass.strip_columns, extent.columns);
    EXPECT_LE(pass.band_rows, extent.rows);
    // The last part begins inside the image and reaches its end.
    EXPECT_LT((pass.strips - 1) * pass.strip_columns, extent.columns);
    EXPECT_GE(pass.strips * pass.strip_columns, extent.columns);
    const int rows = plan.steps == 1 ? extent.rows : plan.step_rows;
    EXPECT_LT((pass.bands - 1) * pass.band_rows, rows);
    EXPECT_GE(pass.bands * pass.band_rows, rows);
    EXPECT_GE(pass.work_ratio, 1.0);
  }
  EXPECT_EQ(next_stage, static_cast<int>(chain.size()));
}

int tasks(const PassPlan& pass) { return pass.strips * pass.bands; }

TEST(StripPlan, CoversImagesOfAnySizeOnce) {
  const int sizes[] = {1, 2, 3, 7, 16, 17, 61, 450, 3840};
  for (const int columns : sizes) {
    for (const int rows : sizes) {
      const GeometryChain chain({columns, rows}, 2, 1);
      for (const int threads : {1, 4, 64}) {
        PlanRequest request;
        request.threads = threads;
        expect_sound(plan_chain(chain.stages(), Machine{}, request), chain.stages());
        ASSERT_FALSE(HasFailure()) << columns << "x" << rows << ", " << threads << " threads";
      }
    }
  }
}

TEST(StripPlan, KeepsToWhatIsAskedFor) {
  const GeometryChain chain({97, 61}, 3, 2);
  for (const int strip_columns : {1, 2, 16, 96, 97, 98, 1000000}) {
    for (const int band_rows : {1, 3, 60, 61, 62, 1000000}) {
      PlanRequest request;
      request.strip_columns = strip_columns;
      request.band_rows = band_rows;
      request.pass_ends = std::vector<int>{1, 4};
      const ChainPlan plan = plan_chain(chain.stages(), Machine{}, request);
      expect_sound(plan, chain.stages());
      ASSERT_EQ(plan.passes.size(), 3U);
      EXPECT_EQ(plan.passes[0].end_stage, 1);
      EXPECT_EQ(plan.passes[1].end_stage, 4);
      for (const PassPlan& pass : plan.passes) {
        EXPECT_EQ(pass.strip_columns, std::min(strip_columns, 97));
        EXPECT_EQ(pass.band_rows, std::min(band_rows, 61));
      }
    }
  }
}

/// A last stage that looks at whole rows.
class WholeRows final : public RowStage {
 public:
  using RowStage::RowStage;
  [[nodiscard]] std::string_view name() const override { return "whole rows"; }
  [[nodiscard]] std::size_t bytes_per_column() const override { return 0; }
  [[nodiscard]] bool needs_whole_rows() const override { return true; }
  [[nodiscard]] Range input_columns(Range /*columns*/, Extent input) const override {
    return input.all_columns();
  }
  void make_row(const RowTask& /*task*/) const override {}
};

TEST(StripPlan, StagesOfWholeRowsAreNotCutIntoStrips) {
  const Extent extent{400, 61};
  const GeometryChain chain(extent, 3, 1);
  std::vector<const RowStage*> stages(chain.stages().begin(), chain.stages().end() - 1);
  const WholeRows last(extent);
  stages.push_back(&last);
  for (const std::optional<int> strip_columns : {std::optional<int>(16), std::optional<int>()}) {
    PlanRequest request;
    request.threads = 8;
    request.strip_columns = strip_columns;
    request.pass_ends = std::vector<int>{3};
    const ChainPlan plan = plan_chain(stages, Machine{}, request);
    expect_sound(plan, stages);
    ASSERT_EQ(plan.passes.size(), 2U);
    EXPECT_EQ(plan.passes[0].strip_columns, strip_columns.value_or(plan.passes[0].strip_columns));
    EXPECT_EQ(plan.passes[1].strips, 1);
    EXPECT_GT(plan.passes[1].bands, 1);  // which leaves threads their work
  }
}

TEST(StripPlan, EmptyListOfPassEndsMeansOnePass) {
  const GeometryChain chain({400, 300}, 60, 3);
  PlanRequest request;
  request.pass_ends = std::vector<int>{};
  EXPECT_EQ(plan_chain(chain.stages(), Machine{}, request).passes.size(), 1U);
}

TEST(StripPlan, ManyThreadsGetEnoughTasks) {
  for (const int threads : {2, 8, 64}) {
    const GeometryChain chain({1282, 1110}, 1, 2);
    PlanRequest request;
    request.threads = threads;
    for (const PassPlan& pass : plan_chain(chain.stages(), Machine{}, request).passes) {
      EXPECT_GE(tasks(pass), 2 * threads) << threads << " threads";
    }
    // Also where the user has chosen one strip.
    request.strip_columns = 1282;
    for (const PassPlan& pass : plan_chain(chain.stages(), Machine{}, request).passes) {
      EXPECT_GE(tasks(pass), std::min(2 * threads, 40)) << threads << " threads";
    }
  }
}

TEST(StripPlan, OneThreadSweepsStripsFromTopToBottom) {
  const GeometryChain chain({1282, 1110}, 1, 2);
  for (const PassPlan& pass : plan_chain(chain.stages(), Machine{}, {}).passes) {
    EXPECT_EQ(pass.bands, 1);
  }
}

TEST(StripPlan, RingsStayInTheLevelTwoCache) {
  Machine machine;
  machine.l2_bytes = 1024 * 1024;
  const GeometryChain chain({3840, 2160}, 4, 1, 1024);
  for (const PassPlan& pass : plan_chain(chain.stages(), machine, {}).passes) {
    EXPECT_LE(pass.scratch_bytes, machine.l2_bytes);
  }
}

TEST(StripPlan, LongChainsWithWideHalosAreSplit) {
  const PlanRequest request;
  // Strips that stay in the cache have halos worth two thirds of their width.
  const GeometryChain longer({3840, 2160}, 20, 1, 64);
  const ChainPlan split = plan_chain(longer.stages(), Machine{}, request);
  expect_sound(split, longer.stages());
  EXPECT_GT(split.passes.size(), 1U);
  EXPECT_GT(split.stored_bytes, 0U);
  double split_work = 0;
  for (const PassPlan& pass : split.passes) {
    split_work += pass.work_ratio * (pass.end_stage - pass.first_stage);
  }
  PlanRequest in_one_pass;
  in_one_pass.pass_ends = std::vector<int>{};
  const PassPlan whole = plan_chain(longer.stages(), Machine{}, in_one_pass).passes.front();
  EXPECT_LT(split_work, whole.work_ratio * longer.size());

  const GeometryChain shorter({3840, 2160}, 3, 0, 64);
  EXPECT_EQ(plan_chain(shorter.stages(), Machine{}, request).passes.size(), 1U);
  EXPECT_EQ(plan_chain(shorter.stages(), Machine{}, request).stored_bytes, 0U);
}

TEST(StripPlan, StoredBytesCoverInputAndOutputOfAPass) {
  const GeometryChain chain({100, 50}, 4, 1, 256);
  PlanRequest request;
  request.pass_ends = std::vector<int>{2};
  EXPECT_EQ(plan_chain(chain.stages(), Machine{}, request).stored_bytes, 100U * 50U * 256U);
  request.pass_ends = std::vector<int>{2, 4};
  EXPECT_EQ(plan_chain(chain.stages(), Machine{}, request).stored_bytes, 2 * 100U * 50U * 256U);
}

TEST(StripPlan, FewTasksKeepAllThreadsBusy) {
  for (const int columns : {383, 450, 640, 800, 1282}) {
    for (const int count : {1, 3, 6, 10}) {
      for (const int threads : {2, 3, 4}) {
        const GeometryChain chain = iterations({columns, 375}, count, 256);
        PlanRequest request;
        request.threads = threads;
        for (const PassPlan& pass : plan_chain(chain.stages(), Machine{}, request).passes) {
          const int rounds = (tasks(pass) + threads - 1) / threads;
          EXPECT_LE(rounds * threads, 1.2 * tasks(pass))
              << columns << " columns, " << count << " iterations, " << threads
              << " threads: " << pass.strips << " x " << pass.bands;
        }
      }
    }
  }
}

TEST(StripPlan, IterationsCostTheSameHoweverManyThereAre) {
  Machine machine;
  machine.l2_bytes = 1024 * 1024;
  const auto plan_of = [&](int count, int threads) {
    PlanRequest request;
    request.threads = threads;
    const GeometryChain chain = iterations({450, 375}, count, 256);
    ChainPlan plan = plan_chain(chain.stages(), machine, request);
    expect_sound(plan, chain.stages());
    return plan;
  };
  for (const int threads : {1, 2}) {
    const ChainPlan ten = plan_of(10, threads);
    ASSERT_EQ(ten.passes.size(), 1U);
    EXPECT_GT(ten.passes[0].scratch_bytes, machine.l2_bytes / 4);
    EXPECT_LE(ten.passes[0].scratch_bytes, machine.l2_bytes * 7 / 8);
    EXPECT_EQ(ten.passes[0].source_rows, 11);
    for (const int count : {50, 200}) {
      const ChainPlan plan = plan_of(count, threads);
      EXPECT_EQ(plan.steps, 1);
      EXPECT_GE(plan.passes.size(), static_cast<std::size_t>(count / 20));
      EXPECT_LE(plan.passes.size(), static_cast<std::size_t>(count / 5));
      EXPECT_LE(expected_time(plan) / count, 1.1 * expected_time(ten) / 10);
      for (const PassPlan& pass : plan.passes) {
        EXPECT_LE(pass.scratch_bytes, machine.l2_bytes * 7 / 8);
      }
    }
  }
}

TEST(StripPlan, StripsFillLevelThreeOnlyWhereItIsNear) {
  Machine machine;
  machine.cores = 2;
  machine.l2_bytes = std::size_t{2} << 20U;
  PlanRequest request;
  const GeometryChain chain = iterations({1282, 1110}, 10, 1024);
  const auto max_scratch = [&](std::size_t l3_megabytes) {
    machine.l3_bytes = l3_megabytes << 20U;
    const ChainPlan plan = plan_chain(chain.stages(), machine, request);
    expect_sound(plan, chain.stages());
    return scratch_bytes(plan);
  };
  for (const int threads : {1, 2}) {
    request.threads = threads;
    EXPECT_GT(max_scratch(64), machine.l2_bytes) << threads;
    // Shared with cores that are out of sight.
    EXPECT_LT(max_scratch(480), machine.l2_bytes) << threads;
    EXPECT_LT(max_scratch(0), machine.l2_bytes) << threads;
  }
  machine.cores = 16;
  for (const int threads : {1, 16}) {
    request.threads = threads;
    EXPECT_LT(max_scratch(300), machine.l2_bytes) << threads;
  }
  // A near one is divided by the threads that use it.
  machine.l2_bytes = std::size_t{1} << 19U;
  request.threads = 1;
  const std::size_t alone = max_scratch(32);
  request.threads = 16;
  EXPECT_GT(alone, 2 * max_scratch(32));
  EXPECT_LE(max_scratch(32), (std::size_t{32} << 20U) / 16);
}

TEST(StripPlan, StripsAreAsWideAsLevelTwoAllows) {
  // Not as narrow as level 1: each row of a strip takes time to start.
  const GeometryChain chain({1282, 540}, 2, 4, 512);
  for (const std::size_t l2_kilobytes : {256U, 512U, 1024U, 2048U}) {
    Machine machine;
    machine.l2_bytes = l2_kilobytes << 10U;
    const PassPlan pass = plan_chain(chain.stages(), machine, {}).passes.front();
    EXPECT_GT(pass.scratch_bytes, machine.l2_bytes / 3) << l2_kilobytes;
    EXPECT_LE(pass.scratch_bytes, machine.l2_bytes) << l2_kilobytes;
  }
}

TEST(StripPlan, StoringStatesCostsTime) {
  const GeometryChain chain({400, 300}, 12, 1);
  PlanRequest request;
  request.pass_ends = std::vector<int>{};
  const ChainPlan whole = plan_chain(chain.stages(), Machine{}, request);
  EXPECT_EQ(total_expected_time(whole), expected_time(whole));
  request.pass_ends = std::vector<int>{4, 8};
  const ChainPlan cut = plan_chain(chain.stages(), Machine{}, request);
  EXPECT_GT(total_expected_time(cut), expected_time(cut) + 2);
}

TEST(StripPlan, PassesOfLargerImagesTakeTheirCellsTime) {
  const Geometry large({1000, 800}, 0, 256);
  const Geometry small({500, 400}, 0, 256);
  const std::vector<const RowStage*> chain = {&large, &small};
  PlanRequest request;
  request.threads = 1;
  request.pass_ends = std::vector<int>{1};
  const std::vector<PassPlan> passes = plan_chain(chain, Machine{}, request).passes;
  EXPECT_NEAR(passes.at(0).expected_time / passes.at(1).expected_time, 4, 0.2);
}

TEST(StripPlan, ShortPassesRunVeryLongChainsToo) {
  for (const Extent extent : {Extent{1, 1}, Extent{20, 15}, Extent{200, 100}}) {
    const GeometryChain chain = iterations(extent, 1000, 64);
    const ChainPlan plan = plan_chain(chain.stages(), Machine{}, {});
    expect_sound(plan, chain.stages());
    EXPECT_GE(plan.passes.size(), 10U);
    EXPECT_LE(plan.passes.size(), 500U);
  }
}

TEST(StripPlan, KeepsWithinTheMemoryGiven) {
  PlanRequest request;
  request.threads = 2;
  // A state is 43 MB. The default allows two of them.
  const GeometryChain small = iterations({450, 375}, 50, 256);
  EXPECT_EQ(plan_chain(small.stages(), Machine{}, request).steps, 1);
  for (const std::size_t megabytes : {1000, 100, 80, 40, 20, 10}) {
    request.memory_bytes = megabytes << 20U;
    const ChainPlan plan = plan_chain(small.stages(), Machine{}, request);
    expect_sound(plan, small.stages());
    EXPECT_LE(bytes_taken(plan, request.threads), *request.memory_bytes) << megabytes;
    EXPECT_EQ(plan.steps > 1, plan.passes.size() > 1 && megabytes < 86) << megabytes;
  }
  // A state is 2.1 GB: more than the default.
  request.memory_bytes.reset();
  for (const int count : {10, 50, 200}) {
    const GeometryChain large = iterations({1920, 1080}, count, 1024);
    const ChainPlan plan = plan_chain(large.stages(), Machine{}, request);
    expect_sound(plan, large.stages());
    EXPECT_GT(plan.steps, 1);
    EXPECT_LE(bytes_taken(plan, request.threads), kDefaultMemoryBytes);
    for (const PassPlan& pass : plan.passes) {
      EXPECT_LT(pass.work_ratio, count <= 50 ? 2.0 : 4.0);
    }
  }
}

TEST(StripPlan, StepsMakeEachRowOnceAndFindTheRowsTheyNeed) {
  const Extent extent{30, 101};
  for (const int halo : {0, 1, 4}) {
    const GeometryChain chain(extent, 11, halo, 64, 1, true);
    PlanRequest request;
    request.pass_ends = std::vector<int>{1, 4, 9, 12};
    for (const std::size_t kilobytes : {900, 500, 300, 200, 1}) {
      request.memory_bytes = kilobytes << 10U;
      const ChainPlan plan = plan_chain(chain.stages(), Machine{}, request);
      std::vector<int> made(plan.passes.size());
      for (int step = 0; step < plan.steps; ++step) {
        for (std::size_t p = 0; p < plan.passes.size(); ++p) {
          const PassPlan& pass = plan.passes[p];
          const Range rows = rows_of_step(plan, pass, step, extent.rows);
          EXPECT_EQ(rows.begin, made[p]);
          EXPECT_GE(rows.size(), 0);
          EXPECT_LE(rows.size(), plan.step_rows);
          made[p] = rows.end;
          if (p > 0 && !rows.empty()) {
            // Of the steps of a pass only the sink has no halo.
            const int stages = pass.end_stage - pass.first_stage;
            const int reach = halo * (stages - (pass.end_stage == chain.size() ? 1 : 0));
            const Range needed = rows.widened(reach, extent.all_rows());
            EXPECT_LE(needed.end, made[p - 1]);
            EXPECT_GE(needed.begin, made[p - 1] - plan.passes[p - 1].stored_rows);
          }
        }
      }
      for (const int end : made) {
        EXPECT_EQ(end, extent.rows);
      }
    }
  }
}

TEST(StripPlan, WorkRatioIsWhatASweepComputes) {
  // Two steps of halo 1 on strips of 10: 10 + 12 + 14 columns, and the sink's 10.
  const GeometryChain chain({100, 80}, 2, 1);
  PlanRequest request;
  request.strip_columns = 10;
  request.band_rows = 80;
  request.pass_ends = std::vector<int>{};
  EXPECT_NEAR(plan_chain(chain.stages(), Machine{}, request).passes[0].work_ratio, 46.0 / 40.0,
              1e-12);
  // Bands of 8: 8 + 10 + 12 rows.
  request.strip_columns = 100;
  request.band_rows = 8;
  EXPECT_NEAR(plan_chain(chain.stages(), Machine{}, request).passes[0].work_ratio, 38.0 / 32.0,
              1e-12);
}

TEST(SweepLayout, AddsUpHalosAndKeepsPartsApart) {
  const Extent extent{100, 80};
  const GeometryChain chain(extent, 3, 2, 128);
  const PassStages pass = pass_stages(chain.stages(), 0, chain.size(), 0);
  SweepLayout layout;
  for (const Range columns : {Range{0, 1}, Range{40, 47}, Range{96, 100}, Range{0, 100}}) {
    for (const Range rows : {Range{0, 1}, Range{30, 33}, Range{79, 80}}) {
      lay_out_sweep(pass, columns, rows, layout);
      const std::vector<StageSweep>& sweep = layout.parts;
      ASSERT_EQ(sweep.size(), 5U);
      for (std::size_t k = 0; k < 5; ++k) {
        const int halo = k == 4 ? 0 : static_cast<int>(3 - k) * 2;
        EXPECT_EQ(sweep[k].columns, columns.widened(halo, extent.all_columns()));
        EXPECT_EQ(sweep[k].first_row, std::max(0, rows.begin - halo));
        EXPECT_EQ(sweep[k].ring_rows, k < 3 ? 5 : 1);
        EXPECT_EQ(sweep[k].row_bytes,
                  k == 4 ? 0U : 128U * static_cast<std::size_t>(sweep[k].columns.size()));
        EXPECT_EQ(sweep[k].ring_offset % 64, 0U);
        EXPECT_EQ(sweep[k].state_offset % 64, 0U);
      }
      // Rings and states lie one behind the other, none over another.
      std::vector<Range> parts;
      for (const StageSweep& part : sweep) {
        parts.push_back(
            {static_cast<int>(part.ring_offset),
             static_cast<int>(part.ring_offset +
                              part.row_bytes * static_cast<std::size_t>(part.ring_rows))});
        parts.push_back({static_cast<int>(part.state_offset),
                         static_cast<int>(part.state_offset) + part.columns.size()});
      }
      for (std::size_t a = 0; a < parts.size(); ++a) {
        EXPECT_LE(parts[a].end, static_cast<int>(layout.scratch_bytes));
        for (std::size_t b = 0; b < a; ++b) {
          EXPECT_TRUE(parts[a].empty() || parts[b].empty() || parts[a].end <= parts[b].begin ||
                      parts[b].end <= parts[a].begin);
        }
      }
    }
  }
}

TEST(SweepLayout, SourceIsKeptForItsLastReader) {
  const Extent extent{100, 80};
  const GeometryChain chain(extent, 6, 2, 128, 1, true);
  const std::vector<RowReach> reaches = row_reaches(chain.stages());
  EXPECT_EQ(reaches[0].below, 0);
  EXPECT_EQ(reaches[1].above, 2);
  EXPECT_EQ(reaches[1].below, 2);
  const auto source_rows = [&](int first, int end) {
    return source_rows_to_keep(chain.stages(), reaches, first, end);
  };
  EXPECT_EQ(source_rows(0, 1), 0);
  EXPECT_EQ(source_rows(0, 2), 3);
  EXPECT_EQ(source_rows(0, 8), 13);
  EXPECT_EQ(source_rows(1, 2), 1);  // beside the pass it waits for its first reader
  EXPECT_EQ(source_rows(3, 8), 7);
  EXPECT_EQ(source_rows(7, 8), 0);

  SweepLayout layout;
  lay_out_sweep(pass_stages(chain.stages(), 3, 8, 7), {40, 50}, {40, 45}, layout);
  ASSERT_EQ(layout.parts.size(), 6U);
  EXPECT_EQ(layout.parts[0].stage, chain.stages()[0]);
  EXPECT_EQ(layout.parts[0].ring_rows, 7);
  EXPECT_EQ(layout.parts[0].columns, layout.parts[1].columns);
  EXPECT_EQ(layout.parts[0].columns, (Range{34, 56}));
  EXPECT_EQ(layout.parts[0].first_row, layout.parts[1].first_row);
  lay_out_sweep(pass_stages(chain.stages(), 0, 8, 13), {40, 50}, {40, 45}, layout);
  ASSERT_EQ(layout.parts.size(), 8U);
  EXPECT_EQ(layout.parts[0].ring_rows, 13);
  EXPECT_EQ(layout.parts[0].columns, (Range{28, 62}));

  // No more rows than there are.
  const GeometryChain low({100, 5}, 6, 2, 128, 1, true);
  EXPECT_EQ(source_rows_to_keep(low.stages(), row_reaches(low.stages()), 0, 8), 5);
}

TEST(Machine, IsDescribedSensibly) {
  const Machine machine = detect_machine();
  EXPECT_GE(machine.cores, 1);
  EXPECT_GE(machine.hardware_threads, machine.cores);
  EXPECT_GE(machine.numa_nodes, 1);
  EXPECT_GE(machine.l1_data_bytes, 4096U);
  EXPECT_GE(machine.l2_bytes, machine.l1_data_bytes);
}

}  // namespace vantage::scheduler::strip_plan_test
