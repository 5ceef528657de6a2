#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/matching/costs/matching_cost.h"
#include "engine/matching/parameters/method_parameters.h"

namespace vantage {

/// All costs, in the order of help texts. Command line, validation, messages, tuning keys and tests
/// read this table.
std::span<const MatchingCost> cost_table();

/// The entry of one cost.
const MatchingCost& cost_of(MatchCost cost);
inline const MatchingCost& cost_of(const MethodParameters& parameters) {
  return cost_of(parameters.cost);
}

/// Whether cells hold −evidence, see MatchingCost.
inline bool is_evidence(const MethodParameters& parameters) {
  return cost_of(parameters).is_evidence;
}

/// s of the entropy (6.15), p ∝ exp(−s (E − Emin)): 1/(2σM²), of evidence 1/σM.
inline double entropy_scale(const MethodParameters& parameters) {
  const double sigma = parameters.sigma_measurement;
  return is_evidence(parameters) ? 1 / sigma : 1 / (2 * sigma * sigma);
}

/// Bounds of the sum of the costs of `partners` images.
CostBounds cost_bounds(const MethodParameters& parameters, int partners);

// Entries of the table, each from its own file.
MatchingCost squared_cost();
MatchingCost absolute_cost();
MatchingCost truncated_cost();
MatchingCost birchfield_tomasi_cost();
MatchingCost gradient_cost();
MatchingCost contaminated_cost();
MatchingCost census_cost();
MatchingCost ray_census_cost();

}  // namespace vantage
