#include "scheduler/strip_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "scheduler/pass_planner.h"

namespace vantage::scheduler {
namespace {

// Storing a state between two passes and loading it again, in units of one stage's work in level 2:
// 3 of Bayes, 5 to 7 of diffusion (Xeon, 2026-11-22), 1 to 2 of either (Zen 4, 2026-11-28).
constexpr double kPassCost = 3.0;
// Numbers of passes to try: all up to kFewPasses, then each about this times the last.
constexpr int kFewPasses = 12;
constexpr double kPassesStep = 1.15;
// Passes of more stages are only made when they are asked for.
constexpr int kMaxStages = 64;

int divide_up(int total, int part) { return (total + part - 1) / part; }

double cells(Extent extent) { return static_cast<double>(extent.columns) * extent.rows; }

/// Plans a chain in passes, with what is the same for every way to cut it.
class ChainPlanner {
 public:
  ChainPlanner(Chain chain, const Machine& machine, const PlanRequest& request)
      : chain_(chain),
        machine_(machine),
        request_(request),
        memory_bytes_(request.memory_bytes.value_or(kDefaultMemoryBytes)),
        reaches_(row_reaches(chain)),
        run_begin_(chain.size()) {
    for (int k = 1; k < static_cast<int>(chain.size()); ++k) {
      run_begin_[at(k)] = like_the_one_before(k) ? run_begin_[at(k - 1)] : k;
    }
  }

  /// `ends`: stage counts after which the chain is cut. Steps of all rows if the memory allows it.
  ChainPlan plan(const std::vector<int>& ends) {
    const int rows = chain_.back()->extent().rows;
    ChainPlan whole = plan_steps(ends, rows, 1);
    if (ends.empty() || fits(whole) || !can_be_skewed(ends)) {
      return whole;
    }
    const int all_rows = rows + whole.passes.back().lag_rows;
    ChainPlan best = whole;
    for (int step_rows = rows; step_rows > 1 && !fits(best);) {
      // Strips, and with them the scratch, depend on the height of a step: never try one twice.
      const int wanted = std::clamp(rows_that_fit(best), 1, step_rows - 1);
      const int steps = divide_up(all_rows, wanted);
      step_rows = divide_up(all_rows, steps);
      best = plan_steps(ends, step_rows, steps);
    }
    // Rings as high as the lag of the last of many passes may take more than two images.
    return fits(best) || best.stored_bytes < whole.stored_bytes ? best : whole;
  }

  [[nodiscard]] bool fits(const ChainPlan& plan) const {
    return plan.stored_bytes + scratch_bytes(plan) <= memory_bytes_;
  }

  /// Whether `a` is to be preferred: it fits and `b` does not, or both or neither do and it is
  /// faster.
  [[nodiscard]] bool is_better(const ChainPlan& a, const ChainPlan& b) const {
    return fits(a) != fits(b) ? fits(a) : total_expected_time(a) < total_expected_time(b);
  }

 private:
  static std::size_t at(int stage) { return static_cast<std::size_t>(stage); }

  /// Whether passes that differ only in having stage k − 1 or k can have the same plan.
  [[nodiscard]] bool like_the_one_before(int k) const {
    const RowStage& a = *chain_[at(k - 1)];
    const RowStage& b = *chain_[at(k)];
    const Extent input = input_extent(chain_, k);
    const int middle = input.columns / 2;
    return k > 1 && input_extent(chain_, k - 1) == input && a.extent() == b.extent() &&
           a.bytes_per_column() == b.bytes_per_column() &&
           a.needs_whole_rows() == b.needs_whole_rows() && a.reads_source() == b.reads_source() &&
           a.window_rows() == b.window_rows() && a.first_row_work() == b.first_row_work() &&
           a.input_columns({middle, middle + 1}, input) ==
               b.input_columns({middle, middle + 1}, input) &&
           a.state_bytes(input.all_columns(), input) == b.state_bytes(input.all_columns(), input) &&
           reaches_[at(k - 1)].above == reaches_[at(k)].above &&
           reaches_[at(k - 1)].below == reaches_[at(k)].below;
  }

  /// Strips and bands of the stages [first, end): planned once for passes of equal stages.
  PassPlan plan_pass(int first, int end, int step_rows) {
    const int source_rows = source_rows_to_keep(chain_, reaches_, first, end);
    const auto make = [&] {
      return PassPlanner(pass_stages(chain_, first, end, source_rows), machine_, request_)
          .plan(step_rows);
    };
    PassPlan plan;
    if (run_begin_[at(first)] == run_begin_[at(end - 1)]) {
      const auto [known, is_new] =
          known_.try_emplace({run_begin_[at(first)], end - first, step_rows});
      if (is_new) {
        known->second = make();
      }
      plan = known->second;
    } else {
      plan = make();
    }
    plan.first_stage = first;
    plan.end_stage = end;
    plan.source_rows = source_rows;
    return plan;
  }

  ChainPlan plan_steps(const std::vector<int>& ends, int step_rows, int steps) {
    ChainPlan plan;
    plan.steps = steps;
    plan.step_rows = step_rows;
    int first = 0;
    for (std::size_t i = 0; i <= ends.size(); ++i) {
      const int end = i < ends.size() ? ends[i] : static_cast<int>(chain_.size());
      const Extent extent = chain_[at(end - 1)]->extent();
      plan.passes.push_back(plan_pass(first, end, steps == 1 ? extent.rows : step_rows));
      PassPlan& pass = plan.passes.back();
      pass.expected_time *= cells(extent) / std::max(1.0, cells(chain_.back()->extent()));
      if (i > 0) {
        pass.lag_rows = plan.passes[i - 1].lag_rows + reach(first, end).below;
        PassPlan& before = plan.passes[i - 1];
        before.stored_rows = chain_[at(first - 1)]->extent().rows;
        if (steps > 1) {
          before.stored_rows = std::min(before.stored_rows, step_rows + halo_rows(first, end));
        }
      }
      first = end;
    }
    plan.stored_bytes = stored_bytes(plan);
    return plan;
  }

  /// Rows of its input that the stages [first, end) together look up and down.
  [[nodiscard]] RowReach reach(int first, int end) const {
    RowReach sum;
    for (int k = first; k < end; ++k) {
      sum.above += reaches_[at(k)].above;
      sum.below += reaches_[at(k)].below;
    }
    return sum;
  }
  [[nodiscard]] int halo_rows(int first, int end) const {
    const RowReach sum = reach(first, end);
    return sum.above + sum.below;
  }

  [[nodiscard]] std::size_t row_bytes(const PassPlan& pass) const {
    const RowStage& last = *chain_[at(pass.end_stage - 1)];
    return last.bytes_per_column() * static_cast<std::size_t>(last.extent().columns);
  }

  /// Rings live together; of whole images only a pass's input and output do.
  [[nodiscard]] std::size_t stored_bytes(const ChainPlan& plan) const {
    std::size_t all = 0;
    std::size_t max_of_two = 0;
    std::size_t before = 0;
    for (const PassPlan& pass : plan.passes) {
      const std::size_t bytes = row_bytes(pass) * static_cast<std::size_t>(pass.stored_rows);
      all += bytes;
      max_of_two = std::max(max_of_two, before + bytes);
      before = bytes;
    }
    return plan.steps > 1 ? all : max_of_two;
  }

  [[nodiscard]] std::size_t scratch_bytes(const ChainPlan& plan) const {
    std::size_t max = 0;
    for (const PassPlan& pass : plan.passes) {
      max = std::max(max, pass.scratch_bytes);
    }
    return max * static_cast<std::size_t>(std::max(1, request_.threads));
  }

  /// The largest steps whose rings fit beside the scratch of `plan`; 0 if none do.
  [[nodiscard]] int rows_that_fit(const ChainPlan& plan) const {
    double per_row = 0;
    double halos = 0;
    for (std::size_t i = 1; i < plan.passes.size(); ++i) {
      const auto bytes = static_cast<double>(row_bytes(plan.passes[i - 1]));
      per_row += bytes;
      halos += bytes * halo_rows(plan.passes[i].first_stage, plan.passes[i].end_stage);
    }
    const double room =
        static_cast<double>(memory_bytes_) - static_cast<double>(scratch_bytes(plan)) - halos;
    return std::max(0, static_cast<int>(std::min(room / per_row, 1e9)));
  }

  /// Whether all passes after the first work row for row on grids of one size.
  [[nodiscard]] bool can_be_skewed(const std::vector<int>& ends) const {
    const int rows = chain_.back()->extent().rows;
    return std::all_of(chain_.begin() + ends.front() - 1, chain_.end(),
                       [&](const RowStage* stage) { return stage->extent().rows == rows; });
  }

  Chain chain_;
  const Machine& machine_;
  const PlanRequest& request_;
  std::size_t memory_bytes_;
  std::vector<RowReach> reaches_;
  std::vector<int> run_begin_;  ///< the first of the like stages that each stage is among
  std::map<std::array<int, 3>, PassPlan> known_;  ///< by run, number of stages, rows of a step
};

}  // namespace

Range rows_of_step(const ChainPlan& plan, const PassPlan& pass, int step, int rows) {
  if (plan.steps == 1) {
    return {0, rows};
  }
  const auto end_of = [&](int steps) {
    return std::clamp(steps * plan.step_rows - pass.lag_rows, 0, rows);
  };
  return {end_of(step), end_of(step + 1)};
}

double total_expected_time(const ChainPlan& plan) {
  double total = kPassCost * static_cast<double>(plan.passes.size() - 1);
  for (const PassPlan& pass : plan.passes) {
    total += pass.expected_time;
  }
  return total;
}

ChainPlan plan_chain(Chain chain, const Machine& machine, const PlanRequest& request) {
  check_source_readers(chain);
  ChainPlanner planner(chain, machine, request);
  if (request.pass_ends) {
    return planner.plan(*request.pass_ends);
  }
  // Long chains have wide cumulative halos and many rings. Cut them into equal passes for as long
  // as that saves more than storing the state costs.
  const int stages = static_cast<int>(chain.size());
  const auto equal_passes = [&](int passes) {
    std::vector<int> ends;
    for (int i = 1; i < passes; ++i) {
      ends.push_back(static_cast<int>(std::lround(static_cast<double>(i) * stages / passes)));
    }
    return planner.plan(ends);
  };
  const int min = divide_up(stages, kMaxStages);
  double least = 0;  // what the stages take in any cut: each makes its cells at least once
  for (const RowStage* stage : chain) {
    least += std::min(1.0, cells(stage->extent()) / std::max(1.0, cells(chain.back()->extent())));
  }
  const auto next = [](int passes) {
    return passes < kFewPasses ? passes + 1 : static_cast<int>(passes * kPassesStep);
  };
  ChainPlan best = equal_passes(min);
  for (int passes = next(min); passes <= stages; passes = next(passes)) {
    if (planner.fits(best) && kPassCost * (passes - 1) + least > total_expected_time(best)) {
      break;
    }
    ChainPlan candidate = equal_passes(passes);
    if (planner.is_better(candidate, best)) {
      best = std::move(candidate);
    }
  }
  return best;
}

}  // namespace vantage::scheduler
