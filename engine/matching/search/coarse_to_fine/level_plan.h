#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "engine/matching/levels/level_bands.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// What the search of one map over levels stores, before anything is allocated: CoarseLevels
/// allocates it, estimates of memory add it up, and searches of parts and plans of chains read it.
/// One level: a search at full size, which stores nothing.
struct LevelPlan {
  std::vector<scheduler::Extent> extents;  ///< of the levels, the image's own first
  int candidates = 1;
  int steps_per_px = 1;      ///< candidates per pixel of disparity
  int cell_bytes = 1;        ///< of a stored cell
  int iterations = 0;        ///< of coarse levels
  bool has_windows = false;  ///< the finest level is searched in windows; not the only one
  /// How many of the finest levels have candidate blocks, never the coarsest, and how many per
  /// tile.
  int pruned_levels = 0;
  int candidate_blocks = 0;
  /// The finest level can do without its smooth_tiles(): it is searched in windows, or pruned with
  /// at most one iteration.
  bool has_check_map = false;
  bool may_share_costs = false;  ///< see can_share_costs()
  LevelBands bands = {};

  [[nodiscard]] int coarsest() const { return static_cast<int>(extents.size()) - 1; }
  [[nodiscard]] scheduler::Extent extent(int level) const {
    return extents[static_cast<std::size_t>(level)];
  }
  [[nodiscard]] int lanes() const {
    return kernels::CandidateGeometry{.count = candidates}.lanes();
  }
  /// Lanes of the result of `level`.
  [[nodiscard]] int result_lanes(int level) const {
    return level < pruned_levels ? std::min(lanes(), candidate_blocks * kernels::kLaneMultiple)
                                 : lanes();
  }
  /// Rows of the costs of `level` ≥ 1 that are held at a time: about.
  [[nodiscard]] int held_cost_rows(int level) const;
  /// Whether the next finer level chooses its candidates from the winners of `level`.
  [[nodiscard]] bool needs_winners(int level) const {
    return level > 0 && (level <= pruned_levels || (level == 1 && has_windows));
  }
  /// All that CoarseLevels holds but for lists of blocks.
  [[nodiscard]] std::size_t bytes() const;
};

/// `image`: of the map. memory_bytes: see level_bands().
LevelPlan level_plan(const MethodParameters& parameters, scheduler::Extent image, int candidates,
                     std::size_t memory_bytes = kDefaultLevelBytes);

}  // namespace vantage
