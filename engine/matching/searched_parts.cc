#include "engine/matching/searched_parts.h"

#include <algorithm>
#include <utility>

#include "engine/matching/levels/level_extents.h"
#include "engine/matching/windows/window_level.h"

namespace vantage {
namespace {

/// Parts of coarser levels would be nearly all of them, because each level reads around them.
constexpr int kMaxLevels = 2;

}  // namespace

std::vector<SearchedParts::OfLevel> coarse_parts(TileMask costs, TileMask winners,
                                                 scheduler::Extent image,
                                                 const MethodParameters& parameters) {
  const std::vector<scheduler::Extent> extents = level_extents(image, parameters.levels);
  std::vector<SearchedParts::OfLevel> levels;
  const int end = std::min(kMaxLevels + 1, static_cast<int>(extents.size()));
  for (int level = 1; level < end; ++level) {
    levels.push_back({costs.regions(), winners.regions()});
    if (level + 1 < end) {
      const scheduler::Extent coarser = extents[static_cast<std::size_t>(level) + 1];
      const int reach = coarse_reach(at_level(parameters, level).iterations);
      costs = costs.widened(coarser, 2, 0, kPartSidePx);
      winners = winners.widened(coarser, 2, reach, kPartSidePx);
    }
  }
  return levels;
}

SearchedParts searched_parts(const TileMask& tiles, const MethodParameters& parameters) {
  const scheduler::Extent image{tiles.width(), tiles.height()};
  const scheduler::Extent level_1 = coarser_extent(image);
  const int reach = coarse_reach(at_level(parameters, 0).iterations);
  return {.levels = coarse_parts(tiles.widened(level_1, 2, 0, kPartSidePx),
                                 tiles.widened(level_1, 2, reach, kPartSidePx), image, parameters),
          .map = tiles};
}

}  // namespace vantage
