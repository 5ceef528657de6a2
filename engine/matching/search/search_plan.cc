#include "engine/matching/search/search_plan.h"

#include <cstdint>

#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/selection/symmetric_energies.h"

namespace vantage {

SearchPlan full_size_plan(const ResolvedMatchOptions& options, const MatchSize& size,
                          std::size_t planes) {
  const MethodParameters& parameters = options.parameters;
  const std::size_t pixels = size.pixels();
  const std::size_t channels =
      parameters.colour == ColourUse::kChannels ? static_cast<std::size_t>(size.channels) : 1;
  const int candidates = candidate_count(options.disparities, parameters);
  return {.levels = level_plan(parameters, size.image, candidates, size.level_bytes),
          .image_bytes = pixels * channels * planes * sizeof(float),
          .edge_bytes = edge_weight_bytes(parameters, pixels),
          .energy_bytes = symmetric_energy_bytes(parameters, size.image, candidates)};
}

}  // namespace vantage
