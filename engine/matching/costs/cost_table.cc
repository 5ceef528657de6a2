#include "engine/matching/costs/cost_table.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vantage {

std::span<const MatchingCost> cost_table() {
  static const std::array table = {
      squared_cost(),  absolute_cost(),     truncated_cost(), birchfield_tomasi_cost(),
      gradient_cost(), contaminated_cost(), census_cost(),    ray_census_cost(),
  };
  return table;
}

const MatchingCost& cost_of(MatchCost cost) {
  return *std::ranges::find(cost_table(), cost, &MatchingCost::key);
}

CostBounds cost_bounds(const MethodParameters& parameters, int partners) {
  // Costs are floats and may exceed the exact bounds slightly.
  constexpr float room = 1.0001F;
  const CostBounds one = cost_of(parameters).make_model(parameters)->energy_bounds();
  // Several partners count as the root of their number (kernels/partner_choice).
  const float count = room * std::sqrt(static_cast<float>(partners));
  return {one.min * count, one.max * count};
}

}  // namespace vantage
