#pragma once

#include <memory>

#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/options/method_parameters.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Last stage: the candidates with the least energies, which cells hold in fixed point
/// (kernels::FixedEnergy), above the least of their column. The confidence is the winner's
/// probability, p ∝ exp(−E); the energy output its −ln p. `blocks`: the candidates that are looked
/// at, in whose lanes cells lie; a winner is refined where both of its neighbours are among them.
/// Null: all. Must outlive the stage.
std::unique_ptr<scheduler::RowStage> make_energy_selection_stage(
    const kernels::CandidateGeometry& geometry, Subpixel subpixel, float steps_per_nat,
    const MapOutputs& outputs, const CandidateBlocks* blocks = nullptr);

}  // namespace vantage
