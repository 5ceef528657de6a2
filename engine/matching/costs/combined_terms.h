#pragma once

#include <algorithm>
#include <cmath>

#include "engine/matching/options/method_parameters.h"
#include "kernels/combined_cost/combined_cost.h"

namespace vantage {

/// σ of the terms that the combined cost has.
inline kernels::CombinedSigmas combined_sigmas(const MethodParameters& parameters) {
  return {.grey_levels = parameters.sigma_measurement,
          .census_share = parameters.sigma_census,
          .gradient_levels_px = parameters.sigma_gradient};
}

/// Σ −log ε: the most that a cell of the combined cost can be.
inline double largest_combined_energy(const MethodParameters& parameters) {
  const int terms =
      1 + (parameters.sigma_census > 0 ? 1 : 0) + (parameters.sigma_gradient > 0 ? 1 : 0);
  return -terms *
         std::log(std::max(kernels::kLeastCombinedEpsilon, parameters.epsilon_measurement));
}

/// What a cell without partner has: half of that. As bad as the worst match, such cells would draw
/// the border of the image, where every true partner is outside, to whatever else is near.
inline double combined_energy_without_partner(const MethodParameters& parameters) {
  return largest_combined_energy(parameters) / 2;
}

}  // namespace vantage
