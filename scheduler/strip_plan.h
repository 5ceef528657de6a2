#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "scheduler/machine.h"
#include "scheduler/row_stage.h"

namespace vantage::scheduler {

/// A chain of stages in order; the stages belong to the caller.
using Chain = std::span<const RowStage* const>;

/// What users tune; what is not set comes from the cost model.
struct PlanRequest {
  int threads = 1;
  std::optional<int> strip_columns;  ///< ≥ 1
  std::optional<int> band_rows;      ///< ≥ 1
  /// Stage counts after which the chain is cut and the state stored as a whole image, increasing,
  /// each in [1, stages − 1]. Empty list: one pass.
  std::optional<std::vector<int>> pass_ends;
};

/// One pass: stages [first, end) swept strip by strip, band by band.
struct PassPlan {
  int first_stage = 0;
  int end_stage = 0;
  int strip_columns = 0;
  int band_rows = 0;
  int strips = 0;
  int bands = 0;
  std::size_t scratch_bytes = 0;  ///< most that one task needs: rings and states
  double work_ratio = 1;          ///< cells computed ÷ cells delivered, halo columns and rows in
  double cache_time = 1;  ///< expected time per cell, 1 where a strip's scratch is in level 1
};

struct ChainPlan {
  std::vector<PassPlan> passes;
  std::size_t stored_bytes = 0;  ///< whole-image state between passes, most at any one time
};

/// Cuts `chain` into passes, strips and bands so that the rings of a strip stay in the level-2
/// cache and there are enough tasks for the threads. Strip and band sizes beyond the image are cut
/// to it. The plan never changes results, only speed.
ChainPlan plan_chain(Chain chain, const Machine& machine, const PlanRequest& request);

/// How one stage takes part in the sweep of a strip: what it makes, where it starts, what it keeps.
struct StageSweep {
  Range columns;
  int first_row = 0;
  std::size_t ring_offset =
      0;  ///< of its output rows in the scratch; unused by a pass's last stage
  std::size_t row_bytes = 0;
  int ring_rows = 0;
  std::size_t state_offset = 0;
};

/// The stages of `pass` (a part of a chain) for one strip and band: cumulative halo, first rows and
/// scratch layout. Appends into `sweep` (cleared first) and returns the scratch bytes needed.
std::size_t lay_out_sweep(Chain pass, Extent pass_input, Range columns, Range rows,
                          std::vector<StageSweep>& sweep);

}  // namespace vantage::scheduler
