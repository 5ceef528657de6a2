#pragma once

#include <cstdint>
#include <memory>

#include "engine/image/image.h"
#include "engine/matching/levels/level_volume.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

// Coarse levels of Bayesian diffusion, in a byte a cell (kernels/compact_likelihoods). Stages see
// float cells where nothing else is said, geometry.lanes() a column; volumes must have that many
// lanes of one byte and outlive the stages.

/// Last stage: the energies −ln p0 of the next coarser level, each `weight` (above 0, at most 1)
/// times the sum of those of four columns (BlockRow), from the likelihoods of a level of
/// geometry.width columns.
std::unique_ptr<scheduler::RowStage> make_likelihood_reduction_stage(
    const kernels::CandidateGeometry& geometry, float weight, LevelVolume& coarser);
/// The same from energies in bytes, in steps of `step`, at most those of compact energies. Lanes
/// that are no candidates hold nothing less than any candidate does.
std::unique_ptr<scheduler::RowStage> make_byte_energy_reduction_stage(
    const kernels::CandidateGeometry& geometry, float step, float weight, LevelVolume& coarser);
/// Row y of `coarser` from the energies of a coarse level. `work`: one number a lane.
void reduce_energy_row(const LevelVolume& finer, int y, float weight, std::uint16_t* work,
                       LevelVolume& coarser);

/// Source stage: the likelihoods of a coarse level, from its energies.
std::unique_ptr<scheduler::RowStage> make_level_likelihood_stage(
    const kernels::CandidateGeometry& geometry, const LevelVolume& energies);

/// What becomes of the probabilities, or energies, that a level ends with.
struct LevelResult {
  LevelVolume* cells = nullptr;
  /// The most probable candidates, the smallest of equals; of the level's size. Null: not wanted.
  Image<std::int32_t>* winners = nullptr;
};
/// Last stage: keeps the probabilities that a level ends with.
std::unique_ptr<scheduler::RowStage> make_level_probability_stage(
    const kernels::CandidateGeometry& geometry, const LevelResult& result);

}  // namespace vantage
