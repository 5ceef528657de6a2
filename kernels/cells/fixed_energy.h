#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vantage::kernels {

// Energies −ln p in fixed point, which vectors of 16-bit numbers add, weight and compare: the same
// on every instruction set.

/// A whole number of steps, 0..kMostEnergy. Lanes that are no candidates hold kMostEnergy.
using FixedEnergy = std::int16_t;
inline constexpr FixedEnergy kMostEnergy = 32767;

/// A factor from 0 to nearly 1, in steps of 2^−15.
using FixedWeight = std::int16_t;
inline constexpr float kFixedWeightUnits = 32768;

/// weight: 0..1; the even one of two that are equally near.
inline FixedWeight fixed_weight(float weight) {
  return static_cast<FixedWeight>(std::min(std::nearbyint(weight * kFixedWeightUnits), 32767.0F));
}

/// weight · energy, halves of a step rounded up.
constexpr FixedEnergy weighted(FixedEnergy energy, FixedWeight weight) {
  return static_cast<FixedEnergy>((energy * weight + 0x4000) >> 15);
}

/// At most kMostEnergy.
constexpr FixedEnergy saturated_sum(FixedEnergy a, FixedEnergy b) {
  return static_cast<FixedEnergy>(std::min(a + b, static_cast<int>(kMostEnergy)));
}

}  // namespace vantage::kernels
