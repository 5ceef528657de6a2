#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "engine/matching/pair_exposure.h"
#include "scheduler/strip_plan.h"

namespace vantage {

/// Seconds spent per part, in the order they ran.
struct StageTime {
  std::string_view name;  ///< static storage
  double seconds = 0;
};

/// What a matcher reports about one call.
struct MatchReport {
  std::vector<StageTime> stages;
  /// Plan of one map; both maps use the same. With several levels it is the plan of the image's own
  /// level; coarser levels, a third of the work, and coarse-only maps use the same settings.
  scheduler::ChainPlan plan;
  /// Width × height × disparities × maps computed, over all levels; on pruned levels only the
  /// candidates processed.
  double cells = 0;
  double finest_cells = 0;   ///< of `cells`, those of the finest level
  double finest_pixels = 0;  ///< width × height × maps computed to the finest level
  /// Exposure and noise estimated from the images, if parameters ask for it; of several views, the
  /// first's.
  std::optional<PairExposure> exposure;
  /// With MatchRequest::previous: the share of tiles that were searched, of the map with more.
  std::optional<double> searched_share;

  /// Adds the work of another map of the same images; keeps the first plan and exposure.
  void add(const MatchReport& other) {
    stages.insert(stages.end(), other.stages.begin(), other.stages.end());
    if (plan.passes.empty()) {
      plan = other.plan;
    }
    cells += other.cells;
    finest_cells += other.finest_cells;
    finest_pixels += other.finest_pixels;
    exposure = exposure ? exposure : other.exposure;
  }
};

}  // namespace vantage
