#include "scheduler/strip_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scheduler/scratch_pool.h"

namespace vantage::scheduler {
namespace {

// How many times the rings and states of one strip may fill a cache. Level 1: stages stream through
// them, so a little too much still hits mostly. Level 2: the rest is for image rows, results and
// whatever else runs on the core.
constexpr double kLevel1Share = 1.2;
constexpr double kLevel2Share = 0.5;
// Time per cell while the strip lives in the level-2 cache or beyond, level 1 being 1.
constexpr double kLevel2Time = 1.35;
constexpr double kBeyondTime = 2.5;
// Tasks per thread that keep the last tasks from leaving threads idle.
constexpr int kTasksPerThread = 4;
// A band repeats the rows that warm up the chain; below this many times their work it is too low.
constexpr int kLeastBandPerWarmUp = 12;
// Narrower strips spend more time on starting rows than on cells.
constexpr int kLeastStripColumns = 16;
// Each candidate strip width is about this part of the one before.
constexpr double kStripWidthStep = 0.8;
// Storing a state between two passes and loading it again, in units of one stage's work.
constexpr double kPassCost = 3.0;
// A plan of our own making stores no more than this between passes.
constexpr std::size_t kMostStoredBytes = std::size_t{1} << 30;

std::size_t aligned(std::size_t bytes) {
  constexpr std::size_t step = ScratchPool::kAlignment;
  return (bytes + step - 1) / step * step;
}

int divide_up(int total, int part) { return (total + part - 1) / part; }

Extent input_extent(Chain chain, int stage) {
  return stage == 0 ? Extent{} : chain[static_cast<std::size_t>(stage) - 1]->extent();
}

/// One pass of a chain and the plans that can be made for it.
class PassPlanner {
 public:
  PassPlanner(Chain chain, int first, int end, const Machine& machine, const PlanRequest& request)
      : pass_(
            chain.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(end - first))),
        input_(input_extent(chain, first)),
        output_(pass_.back()->extent()),
        machine_(machine),
        request_(request) {
    plan_.first_stage = first;
    plan_.end_stage = end;
  }

  PassPlan plan() {
    plan_.strip_columns =
        std::clamp(request_.strip_columns ? *request_.strip_columns : best_width(), 1,
                   std::max(1, output_.columns));
    plan_.strips = std::max(1, divide_up(output_.columns, plan_.strip_columns));
    plan_.band_rows = std::clamp(request_.band_rows ? *request_.band_rows : best_height(), 1,
                                 std::max(1, output_.rows));
    plan_.bands = std::max(1, divide_up(output_.rows, plan_.band_rows));
    for (int strip = 0; strip < plan_.strips; ++strip) {
      const int begin = strip * plan_.strip_columns;
      const Range columns{begin, std::min(begin + plan_.strip_columns, output_.columns)};
      plan_.scratch_bytes = std::max(plan_.scratch_bytes,
                                     lay_out_sweep(pass_, input_, columns, middle_row(), sweep_));
    }
    plan_.work_ratio = work_ratio(plan_.strip_columns, plan_.band_rows);
    plan_.cache_time = cache_time(plan_.scratch_bytes);
    return plan_;
  }

 private:
  [[nodiscard]] Range middle_row() const {
    return {output_.rows / 2, std::min(output_.rows, output_.rows / 2 + 1)};
  }

  std::size_t lay_out_middle_strip(int width, Range rows) {
    const int begin = std::max(0, (output_.columns - width) / 2);
    return lay_out_sweep(pass_, input_, {begin, std::min(output_.columns, begin + width)}, rows,
                         sweep_);
  }

  /// Cells computed ÷ cells delivered, for a strip and band inside the image.
  double work_ratio(int width, int height) {
    const int top = std::max(0, (output_.rows - height) / 2);
    const Range rows{top, std::min(output_.rows, top + height)};
    lay_out_middle_strip(width, rows);
    double computed = 0;
    for (std::size_t k = 0; k < sweep_.size(); ++k) {
      // Rows below the band are needed as far as the rows above it: the halo is symmetric.
      const int halo = std::max(0, rows.begin - sweep_[k].first_row);
      const int all_rows = std::min(rows.size() + 2 * halo, pass_[k]->extent().rows);
      computed += static_cast<double>(sweep_[k].columns.size()) *
                  (all_rows + pass_[k]->first_row_work() - 1);
    }
    const double delivered =
        static_cast<double>(sweep_.size()) * std::min(width, output_.columns) * rows.size();
    return delivered > 0 ? computed / delivered : 1;
  }

  [[nodiscard]] double cache_time(std::size_t scratch_bytes) const {
    const auto bytes = static_cast<double>(scratch_bytes);
    if (bytes <= kLevel1Share * static_cast<double>(machine_.l1_data_bytes)) {
      return 1;
    }
    return bytes <= kLevel2Share * static_cast<double>(machine_.l2_bytes) ? kLevel2Time
                                                                          : kBeyondTime;
  }

  /// Wide strips compute few halo columns, narrow ones stay in a fast cache.
  int best_width() {
    int best = output_.columns;
    double best_time = std::numeric_limits<double>::max();
    for (double wanted = output_.columns; wanted >= 1; wanted *= kStripWidthStep) {
      // Strips of equal width.
      const int width =
          divide_up(output_.columns, divide_up(output_.columns, static_cast<int>(wanted)));
      if (width < kLeastStripColumns && best_time < std::numeric_limits<double>::max()) {
        break;
      }
      const double time =
          cache_time(lay_out_middle_strip(width, middle_row())) * work_ratio(width, output_.rows);
      if (time < best_time) {
        best_time = time;
        best = width;
      }
    }
    return best;
  }

  /// As many bands as threads need beyond the strips, as long as they are worth their warm-up.
  int best_height() {
    const int wanted =
        request_.threads > 1 ? divide_up(kTasksPerThread * request_.threads, plan_.strips) : 1;
    lay_out_middle_strip(plan_.strip_columns, middle_row());
    int warm_up = 0;
    for (std::size_t k = 0; k < sweep_.size(); ++k) {
      warm_up = std::max(warm_up,
                         middle_row().begin - sweep_[k].first_row + pass_[k]->first_row_work() - 1);
    }
    const int most = std::max(1, output_.rows / std::max(1, kLeastBandPerWarmUp * warm_up));
    return divide_up(output_.rows, std::clamp(wanted, 1, most));
  }

  Chain pass_;
  Extent input_;
  Extent output_;
  const Machine& machine_;
  const PlanRequest& request_;
  PassPlan plan_;
  std::vector<StageSweep> sweep_;
};

ChainPlan plan_passes(Chain chain, const std::vector<int>& pass_ends, const Machine& machine,
                      const PlanRequest& request) {
  ChainPlan plan;
  std::size_t stored_before = 0;
  int first = 0;
  for (std::size_t i = 0; i <= pass_ends.size(); ++i) {
    const int end = i < pass_ends.size() ? pass_ends[i] : static_cast<int>(chain.size());
    plan.passes.push_back(PassPlanner(chain, first, end, machine, request).plan());
    const RowStage& last = *chain[static_cast<std::size_t>(end) - 1];
    const std::size_t stored = last.bytes_per_column() *
                               static_cast<std::size_t>(last.extent().columns) *
                               static_cast<std::size_t>(last.extent().rows);
    plan.stored_bytes = std::max(plan.stored_bytes, stored_before + stored);
    stored_before = stored;
    first = end;
  }
  return plan;
}

double cost(const ChainPlan& plan) {
  double total = kPassCost * static_cast<double>(plan.passes.size() - 1);
  for (const PassPlan& pass : plan.passes) {
    total += pass.work_ratio * pass.cache_time * (pass.end_stage - pass.first_stage);
  }
  return total;
}

}  // namespace

std::size_t lay_out_sweep(Chain pass, Extent pass_input, Range columns, Range rows,
                          std::vector<StageSweep>& sweep) {
  sweep.assign(pass.size(), {});
  std::size_t bytes = 0;
  Range wanted_columns = columns;
  int wanted_row = rows.begin;
  int ring_rows = 1;  // of the stage at hand: what the stage after it looks at together
  for (std::size_t k = pass.size(); k-- > 0;) {
    const RowStage& stage = *pass[k];
    const Extent input = k > 0 ? pass[k - 1]->extent() : pass_input;
    StageSweep& part = sweep[k];
    part.columns = wanted_columns;
    part.first_row = stage.sweep_start(wanted_row);
    part.row_bytes =
        aligned(stage.bytes_per_column() * static_cast<std::size_t>(wanted_columns.size()));
    part.ring_rows = ring_rows;
    part.ring_offset = bytes;
    bytes += part.row_bytes * static_cast<std::size_t>(part.ring_rows);
    part.state_offset = bytes;
    bytes += aligned(stage.state_bytes(wanted_columns, input));
    wanted_columns = stage.input_columns(wanted_columns, input);
    wanted_row = stage.input_rows(part.first_row, input).begin;
    ring_rows = stage.window_rows();
  }
  return bytes;
}

ChainPlan plan_chain(Chain chain, const Machine& machine, const PlanRequest& request) {
  if (request.pass_ends) {
    return plan_passes(chain, *request.pass_ends, machine, request);
  }
  // Long chains have wide cumulative halos and many rings. Cut them into equal passes for as long
  // as that saves more than storing the state costs.
  ChainPlan best = plan_passes(chain, {}, machine, request);
  const int stages = static_cast<int>(chain.size());
  for (int passes = 2; passes <= stages; ++passes) {
    std::vector<int> ends;
    for (int i = 1; i < passes; ++i) {
      ends.push_back(static_cast<int>(std::lround(static_cast<double>(i) * stages / passes)));
    }
    ChainPlan candidate = plan_passes(chain, ends, machine, request);
    if (candidate.stored_bytes <= kMostStoredBytes && cost(candidate) < cost(best)) {
      best = std::move(candidate);
    } else if (kPassCost * (passes - 1) > cost(best)) {
      break;
    }
  }
  return best;
}

}  // namespace vantage::scheduler
