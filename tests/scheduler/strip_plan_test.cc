#include "scheduler/strip_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "scheduler/machine.h"

namespace vantage::scheduler {
namespace {

/// A stage that is all geometry: `halo` rows and columns around each cell.
class Geometry final : public RowStage {
 public:
  Geometry(Extent extent, int halo, std::size_t bytes_per_column, int first_row_work = 1)
      : RowStage(extent),
        halo_(halo),
        bytes_per_column_(bytes_per_column),
        first_row_work_(first_row_work) {}
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
  [[nodiscard]] std::size_t state_bytes(Range columns, Extent /*input*/) const override {
    return static_cast<std::size_t>(columns.size());
  }
  void make_row(const RowTask& /*task*/) const override {}

 private:
  int halo_;
  std::size_t bytes_per_column_;
  int first_row_work_;
};

/// A source, `steps` stages with `halo`, and a last stage without output.
class GeometryChain {
 public:
  GeometryChain(Extent extent, int steps, int halo, std::size_t bytes_per_column = 256,
                int first_row_work = 1) {
    add(extent, 0, bytes_per_column, first_row_work);
    for (int step = 0; step < steps; ++step) {
      add(extent, halo, bytes_per_column, 1);
    }
    add(extent, 0, 0, 1);
  }
  [[nodiscard]] Chain stages() const { return chain_; }
  [[nodiscard]] int size() const { return static_cast<int>(chain_.size()); }

 private:
  void add(Extent extent, int halo, std::size_t bytes_per_column, int first_row_work) {
    stages_.push_back(std::make_unique<Geometry>(extent, halo, bytes_per_column, first_row_work));
    chain_.push_back(stages_.back().get());
  }
  std::vector<std::unique_ptr<Geometry>> stages_;
  std::vector<const RowStage*> chain_;
};

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
    EXPECT_LT((pass.bands - 1) * pass.band_rows, extent.rows);
    EXPECT_GE(pass.bands * pass.band_rows, extent.rows);
    EXPECT_GE(pass.work_ratio, 1.0);
  }
  EXPECT_EQ(next_stage, static_cast<int>(chain.size()));
}

Extent extent_of(int columns, int rows) { return {columns, rows}; }

int tasks(const PassPlan& pass) { return pass.strips * pass.bands; }

TEST(StripPlan, CoversImagesOfAnySizeOnce) {
  const int sizes[] = {1, 2, 3, 7, 16, 17, 61, 450, 3840};
  for (const int columns : sizes) {
    for (const int rows : sizes) {
      const GeometryChain chain(extent_of(columns, rows), 2, 1);
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
  std::vector<StageSweep> sweep;
  for (const Range columns : {Range{0, 1}, Range{40, 47}, Range{96, 100}, Range{0, 100}}) {
    for (const Range rows : {Range{0, 1}, Range{30, 33}, Range{79, 80}}) {
      const std::size_t bytes = lay_out_sweep(chain.stages(), {}, columns, rows, sweep);
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
        EXPECT_LE(parts[a].end, static_cast<int>(bytes));
        for (std::size_t b = 0; b < a; ++b) {
          EXPECT_TRUE(parts[a].empty() || parts[b].empty() || parts[a].end <= parts[b].begin ||
                      parts[b].end <= parts[a].begin);
        }
      }
    }
  }
}

TEST(Machine, IsDescribedSensibly) {
  const Machine machine = detect_machine();
  EXPECT_GE(machine.cores, 1);
  EXPECT_GE(machine.hardware_threads, machine.cores);
  EXPECT_GE(machine.numa_nodes, 1);
  EXPECT_GE(machine.l1_data_bytes, 4096U);
  EXPECT_GE(machine.l2_bytes, machine.l1_data_bytes);
}

}  // namespace
}  // namespace vantage::scheduler
