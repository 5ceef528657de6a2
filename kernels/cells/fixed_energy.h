#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vantage::kernels {

// Energies −ln p in fixed point: added, weighted and compared as vectors of 16-bit integers,
// identical on every instruction set.

/// Number of steps, 0..kMaxEnergy. Lanes that are not candidates hold kMaxEnergy.
using FixedEnergy = std::int16_t;
inline constexpr FixedEnergy kMaxEnergy = 32767;

/// Factor in [0, 1), in steps of 2^−15.
using FixedWeight = std::int16_t;
inline constexpr float kFixedWeightUnits = 32768;

/// weight: 0..1. Ties round to even.
inline FixedWeight fixed_weight(float weight) {
  return static_cast<FixedWeight>(std::min(std::nearbyint(weight * kFixedWeightUnits), 32767.0F));
}

/// weight · energy; halves of a step round up.
constexpr FixedEnergy weighted(FixedEnergy energy, FixedWeight weight) {
  return static_cast<FixedEnergy>((energy * weight + 0x4000) >> 15);
}

/// Clamped to kMaxEnergy.
constexpr FixedEnergy saturated_sum(FixedEnergy a, FixedEnergy b) {
  return static_cast<FixedEnergy>(std::min(a + b, static_cast<int>(kMaxEnergy)));
}

}  // namespace vantage::kernels
