#pragma once

#include <vector>

#include "engine/image/tile_mask.h"
#include "engine/matching/parameters/method_parameters.h"
#include "engine/matching/search/coarse_to_fine/level_plan.h"
#include "scheduler/range.h"

namespace vantage {

/// Parts of a coarse-to-fine search to compute; everywhere else values stay as the last search with
/// the same working memory left them, whose images had the same size and candidates.
struct SearchedParts {
  /// Of one level. In each list regions do not overlap.
  struct OfLevel {
    std::vector<scheduler::Region> costs;
    std::vector<scheduler::Region> winners;  ///< and the result, which is undefined elsewhere
    bool has_all_winners = false;            ///< they are computed everywhere
  };
  std::vector<OfLevel> levels;  ///< level 1 first; levels that are not here are computed everywhere
  TileMask map;                 ///< tiles of the finest level

  /// Null: the whole level.
  [[nodiscard]] const OfLevel* of(int level) const {
    return level >= 1 && level <= static_cast<int>(levels.size())
               ? &levels[static_cast<std::size_t>(level) - 1]
               : nullptr;
  }
};

/// Side of tiles of coarse levels in their pixels.
inline constexpr int kPartSidePx = 4;

/// The parts that are computed for `tiles` of the map, where the images changed. `plan`: of the
/// last search.
SearchedParts searched_parts(const TileMask& tiles, const LevelPlan& plan,
                             const MethodParameters& parameters);

}  // namespace vantage
