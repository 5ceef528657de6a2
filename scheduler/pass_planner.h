#pragma once

#include "scheduler/strip_plan.h"
#include "scheduler/sweep_layout.h"

namespace vantage::scheduler {

/// Chooses strips and bands of one pass by expected time: halo cells, warm-up rows, the cache level
/// that a strip's scratch stays in, and threads that wait for the last task.
class PassPlanner {
 public:
  /// `machine` and `request` must outlive the planner.
  PassPlanner(const PassStages& pass, const Machine& machine, const PlanRequest& request);

  /// The plan for steps of up to `step_rows` rows. Leaves stages, lag and stored rows to the
  /// caller.
  PassPlan plan(int step_rows);

 private:
  /// Rows that each part of the sweep makes for a band of `height` rows inside the image.
  [[nodiscard]] std::vector<int> rows_made(int height) const;
  /// Work ratio and expected time of strips as laid out in layout_, `rows` as of rows_made().
  void estimate(const std::vector<int>& rows, PassPlan& plan) const;
  [[nodiscard]] double cache_time(std::size_t scratch_bytes) const;
  /// How much longer than its share of the work a run of `tasks` takes: threads wait for the last.
  [[nodiscard]] double imbalance(int tasks) const;
  void lay_out_middle_strip(int width);

  const PassStages pass_;
  const Extent output_;
  const Machine& machine_;
  const PlanRequest& request_;
  const int threads_;
  const std::size_t memory_bytes_;
  double row_start_columns_ = 0;  ///< work of starting a row, in columns
  SweepLayout layout_;
};

}  // namespace vantage::scheduler
