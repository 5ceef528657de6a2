#include <algorithm>
#include <cmath>

#include "kernels/cells/exp_log.h"
#include "kernels/fixed_energies/fixed_energies.h"

namespace vantage::kernels {
namespace {

/// Writes of_cell(cell) of each candidate and kMaxEnergy of the other lanes.
template <class Row, class OfCell>
void each_column(const Row& row, FixedEnergy* energies, EnergyPitches pitches,
                 const OfCell& of_cell) {
  for (int x = 0; x < row.columns; ++x) {
    const auto* const cells = row.cells + x * (pitches.cells > 0 ? pitches.cells : row.lanes);
    FixedEnergy* const of_column =
        energies + x * (pitches.energies > 0 ? pitches.energies : row.lanes);
    for (int lane = 0; lane < row.lanes; ++lane) {
      of_column[lane] = lane < row.count ? of_cell(cells[lane]) : kMaxEnergy;
    }
  }
}

}  // namespace

void fixed_energies_of_bytes_row_ref(const CompactRow& row, ByteSteps steps, FixedEnergy* energies,
                                     EnergyPitches pitches) {
  each_column(row, energies, pitches, [steps](std::uint8_t byte) { return steps.of(byte); });
}

void fixed_energies_of_likelihoods_row_ref(const LikelihoodRow& row, float steps_per_nat,
                                           FixedEnergy* energies, EnergyPitches pitches) {
  each_column(row, energies, pitches, [steps_per_nat](float likelihood) {
    const float log = log_of_normal(std::max(likelihood, kMinFixedLikelihood));
    return static_cast<FixedEnergy>(std::nearbyint(std::max(log * -steps_per_nat, 0.0F)));
  });
}

void bytes_of_fixed_energies_row_ref(const FixedEnergy* energies, int cells,
                                     FixedWeight bytes_per_step, std::uint8_t* bytes) {
  for (int k = 0; k < cells; ++k) {
    const int byte = weighted(energies[k], bytes_per_step);
    bytes[k] = static_cast<std::uint8_t>(std::min(byte, kMaxCompact));
  }
}

}  // namespace vantage::kernels
