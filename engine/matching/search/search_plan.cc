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
  constexpr std::size_t kCheckedMaps = 2;  // of coarse levels
  const int check_level = options.refinement ? options.refinement->cross_check_level : 0;
  const int candidates = candidate_count(options.disparities, parameters);
  return {.levels = level_plan(parameters, size.image, candidates, size.level_bytes),
          .image_bytes = pixels * channels * planes * sizeof(float),
          .map_bytes = (check_level > 0 ? kCheckedMaps : 0) * (pixels >> 2 * check_level) *
                       sizeof(std::int32_t),
          .edge_bytes = edge_weight_bytes(parameters, pixels),
          .energy_bytes = symmetric_energy_bytes(parameters, size.image, candidates)};
}

}  // namespace vantage
