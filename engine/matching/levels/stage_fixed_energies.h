#pragma once

#include <cstddef>
#include <memory>

#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/level_volume.h"
#include "engine/matching/levels/stage_level_likelihoods.h"
#include "kernels/candidates.h"
#include "kernels/cells/fixed_energy.h"
#include "kernels/fixed_energies/fixed_energies.h"
#include "kernels/kernel_work.h"
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

/// How energies are made from the cells of cost stages.
class EnergyConversion {
 public:
  EnergyConversion(EnergySource source, const EnergyFormat& format, float byte_nats = 0)
      : source_(source),
        steps_per_nat_(format.steps_per_nat()),
        byte_steps_(format.of_bytes(byte_nats)) {}

  /// Of `columns` columns of `lanes` cells each, `count` of them candidates, with `pitch` energies
  /// between columns.
  void convert(const std::byte* cells, int columns, int lanes, int count,
               kernels::FixedEnergy* energies, std::ptrdiff_t pitch) const;
  /// Per candidate.
  [[nodiscard]] kernels::KernelWork work() const;

 private:
  EnergySource source_;
  float steps_per_nat_;
  kernels::ByteSteps byte_steps_;
};

/// Source stage: −ln p0 from the cells of `costs`, a source stage with `count` candidates.
std::unique_ptr<scheduler::RowStage> make_fixed_energy_stage(
    std::unique_ptr<scheduler::RowStage> costs, const EnergyConversion& conversion, int count);

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
