#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "engine/matching/method_parameters.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "kernels/pixel_cost/pixel_cost.h"
#include "kernels/small_census/small_census.h"

namespace vantage {

/// The measurement model (6.26 ff.) at each distance of small census codes, bit for bit what
/// likelihood_of_costs() makes of it.
inline kernels::LikelihoodByDistance small_census_likelihoods(
    const kernels::ContaminatedGaussian& model) {
  constexpr int kLanes = 2 * kernels::kLaneMultiple;
  static_assert(kLanes >= kernels::kSmallCensusDistances);
  std::array<float, kLanes> cells{};
  for (int distance = 0; distance < kLanes; ++distance) {
    cells[static_cast<std::size_t>(distance)] = static_cast<float>(distance);
  }
  kernels::likelihood_of_costs({.columns = 1, .lanes = kLanes, .count = kLanes}, model,
                               cells.data());
  std::array<float, kernels::kSmallCensusDistances> likelihoods{};
  std::copy_n(cells.begin(), likelihoods.size(), likelihoods.begin());
  return kernels::LikelihoodByDistance(likelihoods);
}

/// −ln of the measurement model by distance, in steps of a byte.
struct SmallCensusEnergies {
  kernels::EnergyByDistance by_distance;
  std::uint8_t without_partner = 0;  ///< −ln ε, which no distance exceeds
  float step = kernels::kEnergyStep;
};

/// Steps are as small as bytes have room for, powers of two from 1/8, those of compact energies, to
/// 1/128: sums of four are then as good as those of floats. Energies from 31.9 on count as that.
inline SmallCensusEnergies small_census_energies(const MethodParameters& parameters) {
  constexpr float kLeastStep = 1.0F / 128;
  const double sigma = parameters.sigma_measurement;
  const double epsilon = parameters.epsilon_measurement;
  SmallCensusEnergies energies;
  while (energies.step > kLeastStep &&
         -std::log(epsilon) <= kernels::kMostCompact * (energies.step / 2)) {
    energies.step /= 2;
  }
  const auto in_steps = [&energies](double likelihood) {
    return static_cast<std::uint8_t>(std::min<double>(
        kernels::kMostCompact, std::nearbyint(-std::log(likelihood) / energies.step)));
  };
  for (int distance = 0; distance < kernels::kSmallCensusDistances; ++distance) {
    const double deviations = distance / sigma;
    energies.by_distance.steps[static_cast<std::size_t>(distance)] =
        in_steps((1 - epsilon) * std::exp(-deviations * deviations / 2) + epsilon);
  }
  energies.without_partner = in_steps(epsilon);
  return energies;
}

}  // namespace vantage
