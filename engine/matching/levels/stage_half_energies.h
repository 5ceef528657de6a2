#pragma once

#include <memory>

#include "engine/matching/costs/matching_cost.h"
#include "engine/matching/levels/level_volume.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

// Coarse levels of methods that store energies, in half floats (kernels/half_energies). All stages
// have float cells, geometry.lanes() per column; volumes must have that many lanes of two bytes and
// outlive the stages. `scale`: of halves, see half_scale().

/// The power of two, at most 1, that scales costs within `bounds` to the range of half floats.
float half_scale(const CostBounds& bounds);

/// Last stage: the energies of the next coarser level, each the mean over four columns (BlockRow),
/// from those of a level of geometry.width columns.
std::unique_ptr<scheduler::RowStage> make_half_energy_reduction_stage(
    const kernels::CandidateGeometry& geometry, float scale, LevelVolume& coarser);
/// Row y of `coarser` from the energies of a coarse level.
void reduce_half_energy_row(const LevelVolume& finer, int y, LevelVolume& coarser);

/// Source stage: the energies of a coarse level.
std::unique_ptr<scheduler::RowStage> make_level_half_energy_stage(
    const kernels::CandidateGeometry& geometry, float scale, const LevelVolume& energies);

/// How a level uses the final energies of the coarser one.
enum class CoarserUse {
  kStart,    ///< they replace the level's own energies as the start of iterations
  kSupport,  ///< the level continues with the mean of both
};
/// Input: the level's own energies; output of the same size. Column x of row y reads column x/2 of
/// row y/2 of `coarser`.
std::unique_ptr<scheduler::RowStage> make_coarser_half_energy_stage(
    const kernels::CandidateGeometry& geometry, int height, CoarserUse use, float scale,
    const LevelVolume& coarser);

/// Last stage: stores a level's final energies.
std::unique_ptr<scheduler::RowStage> make_half_energy_store_stage(
    const kernels::CandidateGeometry& geometry, float scale, LevelVolume& energies);

}  // namespace vantage
