#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "engine/matching/parameters/method_parameters.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "kernels/pixel_cost/pixel_cost.h"
#include "kernels/ray_census/ray_census.h"

namespace vantage {

/// The measurement model (6.26 ff.) at each distance of ray census codes, bit-identical to
/// likelihood_of_costs(). thresholds: 1 or 3.
inline kernels::LikelihoodByDistance ray_census_likelihoods(
    const kernels::ContaminatedGaussian& model, int thresholds) {
  std::array<float, kernels::kRayCensusTableBytes> cells{};
  for (std::size_t distance = 0; distance < cells.size(); ++distance) {
    const auto bits = static_cast<float>(distance);
    cells[distance] = thresholds > 1 ? bits * (1.0F / static_cast<float>(thresholds)) : bits;
  }
  constexpr auto kLanes = static_cast<int>(cells.size());
  kernels::likelihood_of_costs({.columns = 1, .lanes = kLanes, .count = kLanes}, model,
                               cells.data());
  std::array<float, kernels::kMaxRayCensusDistances> likelihoods{};
  std::copy_n(cells.begin(), likelihoods.size(), likelihoods.begin());
  return kernels::LikelihoodByDistance(likelihoods);
}

/// −ln of the measurement model by distance, in steps of a byte.
struct RayCensusEnergies {
  kernels::ByteByDistance by_distance;
  std::uint8_t without_partner = 0;  ///< −ln ε, the maximum
  float step = kernels::kEnergyStep;
};

/// Steps are the smallest that bytes can hold: powers of two from 1/8 (that of compact energies) to
/// 1/128. Sums of four are then as good as sums of floats. Energies are capped at 31.9.
inline RayCensusEnergies ray_census_energies(const MethodParameters& parameters) {
  constexpr float kMinStep = 1.0F / 128;
  const double sigma = parameters.sigma_measurement;
  const double epsilon = parameters.epsilon_measurement;
  RayCensusEnergies energies;
  while (energies.step > kMinStep &&
         -std::log(epsilon) <= kernels::kMaxCompact * (energies.step / 2)) {
    energies.step /= 2;
  }
  const auto in_steps = [&energies](double likelihood) {
    return static_cast<std::uint8_t>(std::min<double>(
        kernels::kMaxCompact, std::nearbyint(-std::log(likelihood) / energies.step)));
  };
  const int distances = kernels::ray_census_distances(parameters.census_thresholds);
  for (int distance = 0; distance < distances; ++distance) {
    const double deviations = distance / (sigma * parameters.census_thresholds);
    energies.by_distance.steps[static_cast<std::size_t>(distance)] =
        in_steps((1 - epsilon) * std::exp(-deviations * deviations / 2) + epsilon);
  }
  energies.by_distance.find_last(distances);
  energies.without_partner = in_steps(epsilon);
  return energies;
}

}  // namespace vantage
