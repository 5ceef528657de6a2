#pragma once

#include "scheduler/strip_plan.h"
#include "scheduler/sweep_layout.h"

namespace vantage::scheduler {

/// Chooses strips and bands of one pass by expected time: cells computed ÷ delivered (halo, warm-up
/// rows, starting rows and tasks) × a factor for the cache that holds a strip's scratch × threads
/// that wait for the last task. The factors, and where they were measured, are in the .cc file.
class PassPlanner {
 public:
  /// `machine` and `request` must outlive the planner.
  PassPlanner(const PassStages& pass, const Machine& machine, const PlanRequest& request);

  /// The plan for steps of up to `step_rows` rows. The caller sets stages, lag and stored rows.
  PassPlan plan(int step_rows);

 private:
  /// Rows that each part of the sweep makes for a band of `height` rows inside the image.
  [[nodiscard]] std::vector<int> rows_made(int height) const;
  /// Work ratio and expected time of strips as laid out in layout_; `rows`: from rows_made().
  void estimate(const std::vector<int>& rows, PassPlan& plan) const;
  [[nodiscard]] double cache_time(std::size_t scratch_bytes) const;
  /// Time of `tasks` tasks ÷ that of a perfectly even division: threads wait for the last.
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
