#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "kernels/cells/fixed_energy.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"

namespace vantage::kernels {

// Energies in fixed point from bytes and likelihoods, and back to bytes. All identical on every
// instruction set.

/// Likelihoods below this, e^−87.3, the least of normal floats, count as this: products over
/// several images get that small.
inline constexpr float kLeastFixedLikelihood = std::numeric_limits<float>::min();

/// Steps of an energy that one of a byte stands for, above 0 and below 128, in steps of 1/256.
class ByteSteps {
 public:
  explicit ByteSteps(float steps)
      : units_(static_cast<std::int16_t>(std::min(32767L, std::lround(steps * kUnits)))) {}

  [[nodiscard]] std::int16_t units() const { return units_; }
  /// byte · steps, halves rounded up.
  [[nodiscard]] FixedEnergy of(std::uint8_t byte) const {
    return static_cast<FixedEnergy>((byte * units_ + kUnits / 2) / kUnits);
  }

 private:
  static constexpr int kUnits = 256;
  std::int16_t units_;
};

/// Energies of bytes: those of candidates, kMostEnergy in the other lanes.
void fixed_energies_of_bytes_row(const CompactRow& row, ByteSteps steps, FixedEnergy* energies);
void fixed_energies_of_bytes_row_ref(const CompactRow& row, ByteSteps steps, FixedEnergy* energies);

/// Likelihoods in [0, 1], `lanes` a column.
struct LikelihoodRow {
  const float* cells = nullptr;
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  int count = 0;  ///< candidates: lanes [0, count)
};

/// −ln p · steps_per_nat, rounded, of candidates; kMostEnergy in the other lanes. steps_per_nat:
/// above 0, at most 374.
void fixed_energies_of_likelihoods_row(const LikelihoodRow& row, float steps_per_nat,
                                       FixedEnergy* energies);
void fixed_energies_of_likelihoods_row_ref(const LikelihoodRow& row, float steps_per_nat,
                                           FixedEnergy* energies);

/// energy · bytes_per_step, halves rounded up, at most 255. cells: a multiple of kLaneMultiple.
void bytes_of_fixed_energies_row(const FixedEnergy* energies, int cells, FixedWeight bytes_per_step,
                                 std::uint8_t* bytes);
void bytes_of_fixed_energies_row_ref(const FixedEnergy* energies, int cells,
                                     FixedWeight bytes_per_step, std::uint8_t* bytes);

}  // namespace vantage::kernels
