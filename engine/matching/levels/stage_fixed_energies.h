#pragma once

#include <memory>

#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/level_volume.h"
#include "engine/matching/levels/stage_level_likelihoods.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

// Where the cells of max-product diffusion come from and go to: kernels::FixedEnergy, those of
// lanes that are no candidates kMostEnergy. Volumes hold a byte a cell and must outlive the stages,
// as must blocks: the candidates that are looked at, in whose lanes cells then lie; null: all.

/// What the cells of a stage hold that energies are made of.
enum class EnergySource {
  kBytes,        ///< energies in bytes, in steps of `byte_nats`
  kLikelihoods,  ///< float, in [0, 1]
};

/// Source stage: −ln p0 of the cells of `costs`, a source stage with `count` candidates.
std::unique_ptr<scheduler::RowStage> make_fixed_energy_stage(
    std::unique_ptr<scheduler::RowStage> costs, EnergySource source, int count,
    const EnergyFormat& format, float byte_nats = 0);

/// Source stage: the energies of a coarse level, which are compact ones (stage_level_likelihoods).
std::unique_ptr<scheduler::RowStage> make_level_fixed_energy_stage(
    const kernels::CandidateGeometry& geometry, const LevelVolume& energies,
    const EnergyFormat& format, const CandidateBlocks* blocks = nullptr);

/// Last stage: keeps the energies that a level ends with, the least of each column being 0, in the
/// bytes of the format's results.
std::unique_ptr<scheduler::RowStage> make_level_energy_result_stage(
    const kernels::CandidateGeometry& geometry, const LevelResult& result,
    const EnergyFormat& format, const CandidateBlocks* blocks = nullptr);

}  // namespace vantage
