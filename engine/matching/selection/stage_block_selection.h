#pragma once

#include <memory>

#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/options/method_parameters.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Last stage: what the cell selection stage makes of probabilities, of the candidates that
/// `blocks` says. Input cells are float, blocks.lanes() a column. A winner is refined where both of
/// its neighbours are among them. The confidence is the probability. `blocks` must outlive the
/// stage.
std::unique_ptr<scheduler::RowStage> make_block_selection_stage(
    const kernels::CandidateGeometry& geometry, Subpixel subpixel, const MapOutputs& outputs,
    const CandidateBlocks& blocks);

}  // namespace vantage
