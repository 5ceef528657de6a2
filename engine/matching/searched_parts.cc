#include "engine/matching/searched_parts.h"

#include <algorithm>

#include "engine/matching/levels/level_extents.h"
#include "engine/matching/windows/window_level.h"

namespace vantage {
namespace {

/// Parts of coarser levels would be nearly all of them, because each level reads around them.
constexpr int kMaxLevels = 2;

}  // namespace

SearchedParts searched_parts(const TileMask& tiles, const MethodParameters& parameters) {
  const std::vector<scheduler::Extent> extents =
      level_extents({tiles.width(), tiles.height()}, parameters.levels);
  SearchedParts parts;
  parts.map = tiles;
  TileMask costs = tiles;
  TileMask winners = tiles;
  const int end = std::min(kMaxLevels + 1, static_cast<int>(extents.size()));
  for (int level = 1; level < end; ++level) {
    const scheduler::Extent extent = extents[static_cast<std::size_t>(level)];
    const int reach = coarse_reach(at_level(parameters, level - 1).iterations);
    costs = costs.widened(extent, 2, 0, kPartSidePx);
    winners = winners.widened(extent, 2, reach, kPartSidePx);
    parts.levels.push_back({costs.regions(), winners.regions()});
  }
  return parts;
}

}  // namespace vantage
