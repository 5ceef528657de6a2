#pragma once

#include "scheduler/strip_plan.h"

namespace vantage {

/// What the searches of one call report about their work.
struct SearchReport {
  /// Plan of one map; both maps use the same. With several levels it is the plan of the image's own
  /// level; coarser levels, a third of the work, and coarse-only maps use the same settings.
  scheduler::ChainPlan plan;
  /// Width × height × disparities × maps computed, over all levels; on pruned levels only the
  /// candidates processed.
  double cells = 0;
  double finest_cells = 0;   ///< of `cells`, those of the finest level
  double finest_pixels = 0;  ///< width × height × maps computed to the finest level
};

}  // namespace vantage
