#pragma once

#include <memory>

#include "engine/matching/level_volume.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

// Coarse levels of Bayesian diffusion, in a byte a cell (kernels/compact_likelihoods). All stages
// see float cells, geometry.lanes() a column; volumes must have that many lanes of one byte and
// outlive the stages.

/// Last stage: the energies −ln p0 of the next coarser level, each the sum of those of four columns
/// (BlockRow), from the likelihoods of a level of geometry.width columns.
std::unique_ptr<scheduler::RowStage> make_likelihood_reduction_stage(
    const kernels::CandidateGeometry& geometry, LevelVolume& coarser);
/// Row y of `coarser` from the energies of a coarse level.
void reduce_energy_row(const LevelVolume& finer, int y, LevelVolume& coarser);

/// Source stage: the likelihoods of a coarse level, from its energies.
std::unique_ptr<scheduler::RowStage> make_level_likelihood_stage(
    const kernels::CandidateGeometry& geometry, const LevelVolume& energies);

/// Last stage: keeps the probabilities that a level ends with.
std::unique_ptr<scheduler::RowStage> make_level_probability_stage(
    const kernels::CandidateGeometry& geometry, LevelVolume& probabilities);

}  // namespace vantage
