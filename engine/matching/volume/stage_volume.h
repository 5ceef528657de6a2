#pragma once

#include <memory>

#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/volume/volume_writer.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"
#include "scheduler/row_stage.h"

namespace vantage {

// Last stages that hand all cells to a writer, which must outlive them. Input columns have
// geometry.lanes() cells. `geometry`, `height`: of the level.

/// Float cells that are the values.
std::unique_ptr<scheduler::RowStage> make_value_volume_stage(
    const kernels::CandidateGeometry& geometry, int height, const VolumeWriter& writer);
/// Float likelihoods, of which −ln p is written.
std::unique_ptr<scheduler::RowStage> make_likelihood_volume_stage(
    const kernels::CandidateGeometry& geometry, int height, const VolumeWriter& writer);
/// Fixed-point energies. `blocks`: the candidates processed, whose lanes the cells occupy; null:
/// all.
std::unique_ptr<scheduler::RowStage> make_fixed_energy_volume_stage(
    const kernels::CandidateGeometry& geometry, int height, float steps_per_nat,
    const CandidateBlocks* blocks, const VolumeWriter& writer);

/// `last`, which also hands its input cells to `volume`, one of the stages above of the same input.
std::unique_ptr<scheduler::RowStage> make_stage_beside_volume(
    std::unique_ptr<scheduler::RowStage> last, std::unique_ptr<scheduler::RowStage> volume);

}  // namespace vantage
