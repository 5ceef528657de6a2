#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "engine/matching/pair_levels.h"
#include "scheduler/strip_plan.h"

namespace vantage {

/// Seconds spent per part, in the order they ran.
struct StageTime {
  std::string_view name;  ///< static storage
  double seconds = 0;
};

/// What matching says of itself.
struct MatchReport {
  std::vector<StageTime> stages;
  /// Of one map; both maps use the same. With several levels the image's own: the others', which
  /// are a third of the work, are made the same way, as is a map of coarse levels only.
  scheduler::ChainPlan plan;
  /// Width × height × disparities × maps computed, of all levels; of levels that look at few
  /// candidates those.
  double cells = 0;
  double finest_cells = 0;   ///< of these, the finest level's
  double finest_pixels = 0;  ///< width × height × maps computed to the finest level
  /// What was estimated from the images where parameters ask for it; of several, of the first.
  std::optional<PairLevels> levels;
};

}  // namespace vantage
