#include "engine/matching/costs/cost_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/matching/costs/combined_terms.h"
#include "kernels/census/census.h"

namespace vantage {
namespace {

constexpr double kWhite = 255;

/// Largest response of a gradient filter along one axis (EQUATIONS §2), with room for rounding.
double largest_gradient(GradientFilter filter) {
  switch (filter) {
    case GradientFilter::kCentral:
      return kWhite;
    case GradientFilter::kSobel:
      return 4 * kWhite;
    case GradientFilter::kSimoncelli3:
      return 0.4554 * kWhite;
    case GradientFilter::kSimoncelli5:
      return (0.1077 + 0.2828) * kWhite;
  }
  return 0;
}

CostBounds bounds_of_one(const MethodParameters& parameters) {
  switch (parameters.cost) {
    case MatchCost::kSquared:
      return {0, static_cast<float>(kWhite * kWhite)};
    case MatchCost::kAbsolute:
    case MatchCost::kBirchfieldTomasi:
      return {0, static_cast<float>(kWhite)};
    case MatchCost::kTruncated:
      return {0, static_cast<float>(std::min(kWhite, parameters.truncation))};
    case MatchCost::kContaminated:
      return {0, static_cast<float>(-std::log(parameters.epsilon_measurement))};
    case MatchCost::kCensus:
      return {0, static_cast<float>(kernels::kCensusBits)};
    case MatchCost::kRayCensus:
      return {0, static_cast<float>(kernels::kRayCensusNeighbours)};
    case MatchCost::kCombined:
      // Each of three terms is rounded to whole units.
      return {0, static_cast<float>(largest_combined_energy(parameters) +
                                    3.0 / kernels::kEnergyUnitsPerNat)};
    case MatchCost::kGradient: {
      // The octagon norm is at most (1.4142 + 0.0396 · 1.4142) times the larger component.
      const double longest = 1.04 * std::numbers::sqrt2 * largest_gradient(parameters.gradient);
      return {static_cast<float>(-longest), static_cast<float>(2 * parameters.alpha * longest)};
    }
  }
  return {};
}

}  // namespace

CostBounds cost_bounds(const MethodParameters& parameters, int partners) {
  // Costs are floats: a little more than the exact bounds is possible.
  constexpr float room = 1.0001F;
  const CostBounds one = bounds_of_one(parameters);
  const float count = room * static_cast<float>(partners);
  return {one.least * count, one.largest * count};
}

}  // namespace vantage
