#pragma once

#include <cstdint>
#include <memory>

#include "engine/image/image.h"
#include "engine/matching/levels/level_volume.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"
#include "scheduler/row_stage.h"

namespace vantage {

// Coarse levels of Bayesian diffusion, one byte per cell (kernels/compact_likelihoods). Stages have
// float cells unless stated otherwise, geometry.lanes() per column; volumes must have that many
// lanes of one byte and outlive the stages.

/// Last stage: the energies −ln p0 of the next coarser level, each `weight` (above 0, at most 1)
/// times the sum over four columns (BlockRow), from the likelihoods of a level of geometry.width
/// columns.
std::unique_ptr<scheduler::RowStage> make_likelihood_reduction_stage(
    const kernels::CandidateGeometry& geometry, float weight, LevelVolume& coarser);
/// As make_likelihood_reduction_stage(), from byte energies in steps of `step`, at most the range
/// of compact energies. Padding lanes hold at least as much as any candidate.
std::unique_ptr<scheduler::RowStage> make_byte_energy_reduction_stage(
    const kernels::CandidateGeometry& geometry, float step, float weight, LevelVolume& coarser);
/// The next coarser level of both images.
struct PairLevels {
  LevelVolume& left;
  LevelVolume& right;
};
/// As make_byte_energy_reduction_stage(), for both images, from the left one's energies, which
/// `costs` makes: those of the right one are the same at other columns. The only stage of its
/// chain; sweeps whole rows. `geometry`: of the left image, one candidate per pixel of disparity.
/// without_partner: energy of candidates without a partner.
std::unique_ptr<scheduler::RowStage> make_pair_energy_reduction_stage(
    std::unique_ptr<scheduler::RowStage> costs, const kernels::CandidateGeometry& geometry,
    std::uint8_t without_partner, float step, float weight, const PairLevels& levels);
/// How the energies of a block make those of a pixel of the next coarser level.
struct EnergyReduction {
  float weight = 1;
  /// A candidate may take the energy of an adjacent one at so many nats; infinite: it may not.
  double slant_penalty = 0;
};
/// Columns of row y of `coarser` from the energies of a coarse level. `work`: one number per lane.
void reduce_float_energy_row(const LevelVolume& finer, int y, scheduler::Range columns,
                             const EnergyReduction& reduction, std::uint16_t* work,
                             LevelVolume& coarser);

/// Source stage: the likelihoods of a coarse level, computed from its energies.
std::unique_ptr<scheduler::RowStage> make_level_likelihood_stage(
    const kernels::CandidateGeometry& geometry, const LevelVolume& energies);

/// Outputs for the final probabilities, or energies, of a level.
struct LevelResult {
  LevelVolume* cells = nullptr;
  /// The most probable candidates, ties going to the smallest; size of the level. Null: not
  /// requested.
  Image<std::int32_t>* winners = nullptr;
};
/// Last stage: stores a level's final probabilities.
std::unique_ptr<scheduler::RowStage> make_level_probability_stage(
    const kernels::CandidateGeometry& geometry, const LevelResult& result);

}  // namespace vantage
