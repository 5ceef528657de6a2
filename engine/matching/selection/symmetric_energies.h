#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "engine/matching/levels/level_volume.h"
#include "engine/matching/selection/row_energies.h"
#include "kernels/symmetric_path/symmetric_path.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Energies in steps (§3.17): sums over rows are exact, so that exchanging the images exchanges the
/// results.
struct EnergySteps {
  float min = 0;  ///< energy of 0 steps
  float steps_per_unit = 1;
  std::int32_t match_offset = 0;  ///< kernels::SymmetricRow
  std::int32_t unmatched = 1;     ///< kernels::SymmetricRow

  /// `min`: lower bound of energies; `penalty` > 0: of an unmatched pixel, in their unit.
  static EnergySteps of(double min, double penalty, int width);

  /// Mean energy of a pair in the two images.
  [[nodiscard]] float energy(std::int32_t cost) const {
    return static_cast<float>(cost) / (2 * steps_per_unit);
  }
  /// The energies of `row` in steps, `lanes` per column; kNeverMatched where a candidate does not
  /// count.
  void convert(const kernels::CellRow& row, kernels::StepEnergy* steps) const;
};

/// Bytes of the energies of one image, for images of `extent` and `candidates` disparities; 0 but
/// for selection symmetric.
std::size_t symmetric_energy_bytes(const MethodParameters& parameters, scheduler::Extent extent,
                                   int candidates);

/// Last stage: stores energies in steps, for symmetric selection with the other image. `volume`:
/// geometry.lanes() cells of two bytes per column; outlives the stage.
std::unique_ptr<scheduler::RowStage> make_symmetric_store_stage(
    std::unique_ptr<RowEnergies> energies, const EnergySteps& steps, LevelVolume& volume);

}  // namespace vantage
