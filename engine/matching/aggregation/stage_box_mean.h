#pragma once

#include <memory>
#include <vector>

#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Means over square windows of 2·radius + 1 pixels, cut to the image, as float cells,
/// geometry.lanes() per column: first down columns, then along rows. For coarse levels, whose
/// results are cells; for winners, stage_column_sum and stage_window_selection are faster. All
/// candidates count as having partners.
std::vector<std::unique_ptr<scheduler::RowStage>> make_box_mean_stages(
    const kernels::CandidateGeometry& geometry, int height, int radius);

}  // namespace vantage
