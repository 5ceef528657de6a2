#include <algorithm>
#include <cmath>

#include "kernels/cells/exp_log.h"
#include "kernels/fixed_energies/fixed_energies.h"

namespace vantage::kernels {

void fixed_energies_of_bytes_row_ref(const CompactRow& row, ByteSteps steps,
                                     FixedEnergy* energies) {
  for (int k = 0; k < row.columns * row.lanes; ++k) {
    energies[k] = k % row.lanes < row.count ? steps.of(row.cells[k]) : kMaxEnergy;
  }
}

void fixed_energies_of_likelihoods_row_ref(const LikelihoodRow& row, float steps_per_nat,
                                           FixedEnergy* energies) {
  for (int k = 0; k < row.columns * row.lanes; ++k) {
    const float log = log_of_normal(std::max(row.cells[k], kMinFixedLikelihood));
    const float steps = std::nearbyint(std::max(log * -steps_per_nat, 0.0F));
    energies[k] = k % row.lanes < row.count ? static_cast<FixedEnergy>(steps) : kMaxEnergy;
  }
}

void bytes_of_fixed_energies_row_ref(const FixedEnergy* energies, int cells,
                                     FixedWeight bytes_per_step, std::uint8_t* bytes) {
  for (int k = 0; k < cells; ++k) {
    const int byte = weighted(energies[k], bytes_per_step);
    bytes[k] = static_cast<std::uint8_t>(std::min(byte, kMaxCompact));
  }
}

}  // namespace vantage::kernels
