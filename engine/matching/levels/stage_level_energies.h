#pragma once

#include <memory>

#include "engine/matching/costs/cost_bounds.h"
#include "engine/matching/levels/level_volume.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

// Coarse levels of methods that keep energies, in half floats (kernels/half_energies). All stages
// see float cells, geometry.lanes() a column; volumes must have that many lanes of two bytes and
// outlive the stages. `scale`: of halves, see half_scale().

/// The power of two, at most 1, that brings costs within `bounds` into the range of half floats.
float half_scale(const CostBounds& bounds);

/// Last stage: the energies of the next coarser level, each the mean of those of four columns
/// (BlockRow), from those of a level of geometry.width columns.
std::unique_ptr<scheduler::RowStage> make_energy_reduction_stage(
    const kernels::CandidateGeometry& geometry, float scale, LevelVolume& coarser);
/// Row y of `coarser` from the energies of a coarse level.
void reduce_half_energy_row(const LevelVolume& finer, int y, LevelVolume& coarser);

/// Source stage: the energies of a coarse level.
std::unique_ptr<scheduler::RowStage> make_level_energy_stage(
    const kernels::CandidateGeometry& geometry, float scale, const LevelVolume& energies);

/// What a level makes of the energies that the coarser one ended with.
enum class CoarserUse {
  kStart,    ///< iterations begin with them instead of the level's own
  kSupport,  ///< the mean of both is what the level goes on with
};
/// Stage of the size of its input, the level's own energies. Column x of row y lies in column x/2
/// of row y/2 of `coarser`.
std::unique_ptr<scheduler::RowStage> make_coarser_energy_stage(
    const kernels::CandidateGeometry& geometry, int height, CoarserUse use, float scale,
    const LevelVolume& coarser);

/// Last stage: keeps the energies that a level ends with.
std::unique_ptr<scheduler::RowStage> make_energy_store_stage(
    const kernels::CandidateGeometry& geometry, float scale, LevelVolume& energies);

}  // namespace vantage
