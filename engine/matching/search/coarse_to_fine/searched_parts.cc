#include "engine/matching/search/coarse_to_fine/searched_parts.h"

#include <algorithm>

#include "engine/matching/windows/window_level.h"

namespace vantage {
namespace {

/// Winners of parts of coarser levels would be nearly all of them, because each level reads around
/// them.
constexpr int kMaxLevels = 2;

}  // namespace

SearchedParts searched_parts(const TileMask& tiles, const LevelPlan& plan,
                             const MethodParameters& parameters) {
  SearchedParts parts;
  parts.map = tiles;
  TileMask costs = tiles;
  TileMask winners = tiles;
  for (int level = 1; level <= plan.coarsest(); ++level) {
    const scheduler::Extent extent = plan.extent(level);
    costs = costs.widened(extent, 2, 0, kPartSidePx);
    if (level > kMaxLevels) {
      parts.levels.push_back({.costs = costs.regions(), .winners = {}, .has_all_winners = true});
      continue;
    }
    const int reach = coarse_reach(at_level(parameters, level - 1).iterations);
    winners = winners.widened(extent, 2, reach, kPartSidePx);
    parts.levels.push_back({.costs = costs.regions(), .winners = winners.regions()});
  }
  return parts;
}

}  // namespace vantage
