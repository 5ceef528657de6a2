#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/cells/fixed_energy.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"

namespace vantage::kernels {

// Fixed-point energies from bytes and likelihoods, and back to bytes. All functions are identical
// on every instruction set.

/// Likelihoods are clamped to at least this, e^−87.3, the smallest normal float: products over
/// several images get that small.
inline constexpr float kMinFixedLikelihood = std::numeric_limits<float>::min();

/// Fixed-point steps per step of a byte energy, in (0, 128), in units of 1/256.
class ByteSteps {
 public:
  explicit ByteSteps(float steps)
      : units_(static_cast<std::int16_t>(std::min(32767L, std::lround(steps * kUnits)))) {}

  [[nodiscard]] std::int16_t units() const { return units_; }
  /// Nats per step of a byte.
  [[nodiscard]] double nats(float steps_per_nat) const {
    return static_cast<double>(units_) / kUnits / static_cast<double>(steps_per_nat);
  }
  /// byte · steps; halves round up.
  [[nodiscard]] FixedEnergy of(std::uint8_t byte) const {
    return static_cast<FixedEnergy>((byte * units_ + kUnits / 2) / kUnits);
  }

 private:
  static constexpr int kUnits = 256;
  std::int16_t units_;
};

/// Cells between columns, at least row.lanes, multiples of kLaneMultiple; 0: row.lanes.
struct EnergyPitches {
  std::ptrdiff_t cells = 0;     ///< of the row's own cells
  std::ptrdiff_t energies = 0;  ///< of the result
};

/// Fixed-point energies of byte energies; kMaxEnergy in lanes that are not candidates.
void fixed_energies_of_bytes_row(const CompactRow& row, ByteSteps steps, FixedEnergy* energies,
                                 EnergyPitches pitches = {});

/// Likelihoods in [0, 1], `lanes` per column.
struct LikelihoodRow {
  const float* cells = nullptr;
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  int count = 0;  ///< candidates: lanes [0, count)
};

/// −ln p · steps_per_nat, rounded, for candidates; kMaxEnergy in the other lanes. steps_per_nat:
/// above 0, at most 374.
void fixed_energies_of_likelihoods_row(const LikelihoodRow& row, float steps_per_nat,
                                       FixedEnergy* energies, EnergyPitches pitches = {});

/// energy · bytes_per_step; halves round up, at most 255. cells: a multiple of kLaneMultiple.
void bytes_of_fixed_energies_row(const FixedEnergy* energies, int cells, FixedWeight bytes_per_step,
                                 std::uint8_t* bytes);

}  // namespace vantage::kernels
