#pragma once

#include <cstddef>
#include <vector>

#include "scheduler/chain_geometry.h"

namespace vantage::scheduler {

/// How one stage takes part in the sweep of a strip: what it makes, where it starts, what it keeps.
struct StageSweep {
  const RowStage* stage = nullptr;
  bool reads_source = false;
  Range columns;
  int first_row = 0;
  std::size_t ring_offset =
      0;  ///< of its output rows in the scratch; unused by a pass's last stage
  std::size_t row_bytes = 0;
  int ring_rows = 0;
  std::size_t state_offset = 0;
};

/// The sweep of a pass down one strip and band.
struct SweepLayout {
  /// The stages of the pass, before them the chain's first stage where it runs beside the pass.
  std::vector<StageSweep> parts;
  std::size_t scratch_bytes = 0;
};

/// Lays out the sweep that makes `columns` of `rows`: cumulative halo, first rows and scratch.
/// Fills `layout`, whose memory it reuses.
void lay_out_sweep(const PassStages& pass, Range columns, Range rows, SweepLayout& layout);

}  // namespace vantage::scheduler
