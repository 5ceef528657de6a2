#include "scheduler/pass_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage::scheduler {
namespace {

// The part of level 2 that the rings and states of a strip may fill before the next level is felt:
// the rest is for image rows, results and whatever else runs on the core. Level 1 does not matter:
// strips that fit into it are so narrow that starting rows costs more than it saves (SSD on
// 1282x540x128, 25 columns in level 1: 1.4 times as long as 160 to 1282 in level 2; Zen 4,
// 2026-11-28).
constexpr double kLevel2Share = 0.75;
// A stage reads half of its bytes in rows that the one before has just made, so that time per cell
// grows slowly with what does not fit, by so much per doubling. In a level 3 of a few cores: 1.0 to
// 1.1 times the time in level 2 at twice its size, 1.0 (local stopping) to 1.3 (membrane) at ten
// times (1282x540x128, Zen 4, 2026-11-28).
constexpr double kNearLevel3Slope = 0.05;
// Beyond the thread's share of that, up to the time from memory: 1.9 to 2.6 at twice the share,
// likewise. From the end of level 2 where level 3 is far: 1.1 to 1.5 at 1.3 times kLevel2Share, 1.6
// to 2.4 at 1.9 times, 1.9 to 3.3 at 7 to 13 times (Bayes and diffusion on 1282x278x256, Xeon with
// 480 MiB, 2026-11-22).
constexpr double kFarSlope = 1.0;
constexpr double kMemoryTime = 3.0;
// The part of level 3 that the strips of all threads may fill: images, stored rows and other
// programs want room too.
constexpr double kLevel3Share = 0.4;
// A larger level 3 is that of dozens of cores, far from each, and few of them may be in sight: of a
// virtual machine or an affinity mask. Those that a ring of cores shares end at 96 MiB.
constexpr std::size_t kMaxNearLevel3 = std::size_t{96} << 20;
// Starting a row of a stage takes as long as this many bytes of its cells.
constexpr double kRowStartBytes = 1024;
// Setting out a stage in a task takes as long as starting this many rows.
constexpr int kTaskStartRows = 8;
// Tasks take unequal time: at the end of a pass threads wait for this part of a task.
constexpr double kUnevenTask = 0.15;
// What goes before and after a pass is mostly made in bands of rows. A pass whose bands do not
// divide among the threads reads more of what other cores made, and its time grows by this factor.
// It is an average: 1 where cores share a level 3, up to 1.1 where they do not (`fast` on 741x497,
// two cores of an EPYC, 2026-11-26).
constexpr double kRowsOfOtherCores = 1.03;
// More tasks per thread than this gain nothing.
constexpr int kMaxTasksPerThread = 8;
// Narrower strips are only tried when they are asked for.
constexpr int kMinStripColumns = 16;
// Numbers of strips and bands to try: all up to kSmallCount, then each about this times the last.
constexpr int kSmallCount = 12;
constexpr double kCountStep = 1.2;

int divide_up(int total, int part) { return (total + part - 1) / part; }

int next_count(int count) {
  return count < kSmallCount ? count + 1 : static_cast<int>(count * kCountStep);
}

/// Sizes of equal parts of `total`, from the whole down to `min` (the whole in any case).
std::vector<int> part_sizes(int total, int min, int max_parts) {
  std::vector<int> sizes = {std::max(1, total)};
  for (int count = 2; count <= max_parts && divide_up(total, count) >= min;
       count = next_count(count)) {
    if (const int size = divide_up(total, count); size != sizes.back()) {
      sizes.push_back(size);
    }
  }
  return sizes;
}

}  // namespace

PassPlanner::PassPlanner(const PassStages& pass, const Machine& machine, const PlanRequest& request)
    : pass_(pass),
      output_(pass.stages.back()->extent()),
      machine_(machine),
      request_(request),
      threads_(std::max(1, request.threads)),
      memory_bytes_(request.memory_bytes.value_or(kDefaultMemoryBytes)) {
  std::size_t bytes = 0;
  for (const RowStage* stage : pass.stages) {
    bytes = std::max(bytes, stage->bytes_per_column());
  }
  row_start_columns_ = kRowStartBytes / static_cast<double>(std::max<std::size_t>(bytes, 64));
}

PassPlan PassPlanner::plan(int step_rows) {
  step_rows = std::clamp(step_rows, 1, std::max(1, output_.rows));
  const bool is_uncut =
      std::any_of(pass_.stages.begin(), pass_.stages.end(),
                  [](const RowStage* stage) { return stage->needs_whole_rows(); });
  const std::vector<int> widths =
      is_uncut ? std::vector{std::max(1, output_.columns)}
      : request_.strip_columns
          ? std::vector{std::clamp(*request_.strip_columns, 1, std::max(1, output_.columns))}
          : part_sizes(output_.columns, kMinStripColumns, output_.columns);
  const std::vector<int> heights =
      request_.band_rows
          ? std::vector{std::clamp(*request_.band_rows, 1, step_rows)}
          : part_sizes(step_rows, 1, threads_ > 1 ? kMaxTasksPerThread * threads_ : 1);
  std::vector<std::vector<int>> rows;
  for (const int height : heights) {
    rows.push_back(rows_made(height));
  }
  PassPlan best;
  bool best_fits = false;
  best.expected_time = std::numeric_limits<double>::max();
  for (const int width : widths) {
    lay_out_middle_strip(width);
    const bool fits = layout_.scratch_bytes * static_cast<std::size_t>(threads_) <= memory_bytes_;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      PassPlan plan;
      plan.strip_columns = width;
      plan.strips = std::max(1, divide_up(output_.columns, width));
      plan.band_rows = heights[i];
      plan.bands = divide_up(step_rows, heights[i]);
      estimate(rows[i], plan);
      if (fits != best_fits ? fits : plan.expected_time < best.expected_time) {
        best = plan;
        best_fits = fits;
      }
    }
  }
  for (int strip = 0; strip < best.strips; ++strip) {
    const int begin = strip * best.strip_columns;
    const Range columns{begin, std::min(begin + best.strip_columns, output_.columns)};
    lay_out_sweep(pass_, columns, {0, 1}, layout_);
    best.scratch_bytes = std::max(best.scratch_bytes, layout_.scratch_bytes);
  }
  return best;
}

std::vector<int> PassPlanner::rows_made(int height) const {
  const int top = std::max(0, (output_.rows - height) / 2);
  Range wanted{top, std::min(output_.rows, top + height)};
  Range source = wanted;
  const std::size_t beside = pass_.source == nullptr ? 0 : 1;
  std::vector<int> rows(pass_.stages.size() + beside);
  for (std::size_t k = pass_.stages.size(); k-- > 0;) {
    const RowStage& stage = *pass_.stages[k];
    const Extent input = k > 0 ? pass_.stages[k - 1]->extent() : pass_.input;
    const Range made{stage.sweep_start(wanted.begin), wanted.end};
    rows[k + beside] = made.size();
    if (stage.reads_source()) {
      source = {std::min(source.begin, made.begin), std::max(source.end, made.end)};
    }
    if (!made.empty()) {
      wanted = {stage.input_rows(made.begin, input).begin,
                stage.input_rows(made.end - 1, input).end};
    }
  }
  if (pass_.source != nullptr) {
    rows[0] = source.end - pass_.source->sweep_start(source.begin);
  }
  return rows;
}

void PassPlanner::estimate(const std::vector<int>& rows, PassPlan& plan) const {
  double computed = 0;
  double starts = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const StageSweep& part = layout_.parts[k];
    const int row_works = rows[k] + part.stage->first_row_work() - 1;
    computed += static_cast<double>(part.columns.size()) * row_works;
    starts += row_works + kTaskStartRows;
  }
  const double delivered = std::max(1.0, static_cast<double>(pass_.stages.size()) *
                                             std::min(plan.strip_columns, output_.columns) *
                                             std::min(plan.band_rows, output_.rows));
  plan.work_ratio = std::max(1.0, computed / delivered);
  const double work = plan.work_ratio + starts * row_start_columns_ / delivered;
  const bool reads_of_others = threads_ > 1 && plan.strips > 1 && plan.bands % threads_ != 0;
  plan.expected_time =
      work * cache_time(layout_.scratch_bytes) * imbalance(plan.strips * plan.bands) *
      (reads_of_others ? kRowsOfOtherCores : 1) * static_cast<double>(pass_.stages.size());
}

double PassPlanner::cache_time(std::size_t scratch_bytes) const {
  const auto bytes = static_cast<double>(scratch_bytes);
  const double near = kLevel2Share * static_cast<double>(machine_.l2_bytes);
  const double of_thread = machine_.l3_bytes > kMaxNearLevel3
                               ? 0
                               : kLevel3Share * static_cast<double>(machine_.l3_bytes) / threads_;
  const double far = std::max(near, of_thread);
  const double time = 1 + kNearLevel3Slope * std::log2(std::clamp(bytes, near, far) / near) +
                      kFarSlope * std::log2(std::max(bytes, far) / far);
  return std::min(time, kMemoryTime);
}

double PassPlanner::imbalance(int tasks) const {
  return threads_ == 1 ? 1 : (divide_up(tasks, threads_) + kUnevenTask) * threads_ / tasks;
}

void PassPlanner::lay_out_middle_strip(int width) {
  const int begin = std::max(0, (output_.columns - width) / 2);
  const int row = output_.rows / 2;
  lay_out_sweep(pass_, {begin, std::min(output_.columns, begin + width)}, {row, row + 1}, layout_);
}

}  // namespace vantage::scheduler
