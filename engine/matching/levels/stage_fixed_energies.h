#pragma once

#include <memory>

#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/level_volume.h"
#include "engine/matching/levels/stage_level_likelihoods.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

// First and last stages of max-product diffusion. Cells are kernels::FixedEnergy; those of padding
// lanes are kMaxEnergy. Volumes hold one byte per cell and must outlive the stages, as must
// `blocks`: the candidates processed, whose lanes the cells occupy; null: all.

/// Input cells from which energies are made.
enum class EnergySource {
  kBytes,        ///< byte energies in steps of `byte_nats`
  kLikelihoods,  ///< float, in [0, 1]
};

/// Source stage: −ln p0 from the cells of `costs`, a source stage with `count` candidates.
std::unique_ptr<scheduler::RowStage> make_fixed_energy_stage(
    std::unique_ptr<scheduler::RowStage> costs, EnergySource source, int count,
    const EnergyFormat& format, float byte_nats = 0);

/// Source stage: the energies of a coarse level in compact form (stage_level_likelihoods).
std::unique_ptr<scheduler::RowStage> make_level_fixed_energy_stage(
    const kernels::CandidateGeometry& geometry, const LevelVolume& energies,
    const EnergyFormat& format, const CandidateBlocks* blocks = nullptr);

/// Last stage: stores a level's final energies, relative to the minimum of each column, in the
/// bytes of the format's results.
std::unique_ptr<scheduler::RowStage> make_level_fixed_energy_result_stage(
    const kernels::CandidateGeometry& geometry, const LevelResult& result,
    const EnergyFormat& format, const CandidateBlocks* blocks = nullptr);

}  // namespace vantage
