#pragma once

#include <memory>

#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Float costs to int32_t cells, (cost + offset) · scale rounded, summed over the 2·radius + 1 rows
/// of a window, cut to the image: the input of make_window_selection_stage() with index_bits = 0.
/// Integers make running sums exact, whatever row a sweep begins at. Cells without a partner are
/// treated as make_column_ssd_stage() does.
/// Costs must lie in [−offset, (2³¹ − 2) / scale / (2·radius + 1)² − offset].
std::unique_ptr<scheduler::RowStage> make_column_sum_stage(
    const kernels::CandidateGeometry& geometry, int height, int radius, float offset, float scale);

}  // namespace vantage
