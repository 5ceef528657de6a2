#pragma once

#include <memory>

#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/selection/energy_selector.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Last stage: selects the candidates with the smallest energies. Cells are fixed-point
/// (kernels::FixedEnergy), relative to the minimum of their column. The confidence is the winner's
/// probability, p ∝ exp(−E); the energy output is its −ln p. `blocks`: the candidates processed,
/// whose lanes the cells occupy; a winner is refined if both of its neighbours are among them.
/// Null: all. Must outlive the stage.
std::unique_ptr<scheduler::RowStage> make_fixed_energy_selection_stage(
    const kernels::CandidateGeometry& geometry, int height, const EnergySelector& selector,
    const CandidateBlocks* blocks = nullptr);

}  // namespace vantage
