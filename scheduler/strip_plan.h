#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scheduler/chain_geometry.h"
#include "scheduler/machine.h"

namespace vantage::scheduler {

/// Memory limit of a plan, unless the request sets one.
inline constexpr std::size_t kDefaultMemoryBytes = std::size_t{1} << 30;

/// Settings of the user; those that are not set come from the cost model.
struct PlanRequest {
  int threads = 1;
  std::optional<int> strip_columns;  ///< ≥ 1
  std::optional<int> band_rows;      ///< ≥ 1
  /// Stage counts after which the chain is cut and the state stored, increasing, each in
  /// [1, stages − 1]. Empty list: one pass.
  std::optional<std::vector<int>> pass_ends;
  /// Limit, as far as possible, of the rows stored between passes plus the scratch of all threads;
  /// kDefaultMemoryBytes when not set.
  std::optional<std::size_t> memory_bytes;
};

/// One pass: stages [first, end) swept strip by strip, band by band, step by step.
struct PassPlan {
  int first_stage = 0;
  int end_stage = 0;
  int strip_columns = 0;
  int band_rows = 0;
  int strips = 0;
  int bands = 0;        ///< of a step
  int lag_rows = 0;     ///< rows by which it lags the first pass, if there are several steps
  int stored_rows = 0;  ///< rows of its output kept for the next pass; 0 for the last pass
  int source_rows = 0;  ///< see PassStages
  std::size_t scratch_bytes = 0;  ///< maximum of one task: rings and states
  double work_ratio = 1;          ///< cells computed ÷ cells delivered, halo columns and rows in
  /// In units of one stage over the chain's last image, in level 2 on all threads.
  double expected_time = 0;
};

/// If whole images of state between passes exceed the memory limit, the image is processed in
/// steps. In each step every pass in turn makes up to `step_rows` rows. A pass lags the one before
/// it by the rows that it reads below, so only a ring of rows is stored between them.
struct ChainPlan {
  std::vector<PassPlan> passes;
  int steps = 1;
  int step_rows = 0;             ///< all rows where there is one step
  std::size_t stored_bytes = 0;  ///< peak of the rows stored between passes
};

/// The rows of its output, which has `rows` rows, that `pass` of `plan` makes in `step`; may be
/// empty.
Range rows_of_step(const ChainPlan& plan, const PassPlan& pass, int step, int rows);

/// Expected time of all passes (PassPlan::expected_time) and of storing rows between them.
double total_expected_time(const ChainPlan& plan);

/// Cuts `chain` into passes, strips and bands so that the rings of a strip stay in the level-2
/// cache and there are enough tasks for the threads. Strip and band sizes beyond the image are cut
/// to it. The plan never changes results, only speed. Throws std::logic_error for a chain that
/// breaks the rules of RowStage::reads_source().
ChainPlan plan_chain(Chain chain, const Machine& machine, const PlanRequest& request);

}  // namespace vantage::scheduler
