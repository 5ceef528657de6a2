#include "engine/matching/search/coarse_to_fine/level_plan.h"

#include <array>
#include <cstdint>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/levels/level_extents.h"

namespace vantage {

LevelPlan level_plan(const MethodParameters& parameters, scheduler::Extent image, int candidates,
                     std::size_t memory_bytes) {
  LevelPlan plan{.extents = level_extents(image, parameters.levels),
                 .candidates = candidates,
                 .steps_per_px = steps_per_px(parameters),
                 .cell_bytes = has_likelihoods(parameters) ? 1 : 2,
                 .iterations = parameters.iterations,
                 .candidate_blocks = parameters.candidate_blocks,
                 .may_share_costs = can_share_costs(parameters, image, candidates)};
  plan.has_windows = parameters.window_levels > 0 && plan.coarsest() > 0;
  const int pruned = std::min(parameters.pruned_levels, plan.coarsest());
  if (parameters.candidate_blocks > 0 && pruned > (plan.has_windows ? 1 : 0)) {
    plan.pruned_levels = pruned;
  }
  plan.has_check_map =
      plan.has_windows || (plan.pruned_levels > 0 && at_level(parameters, 0).iterations <= 1);
  plan.bands = level_bands(plan.extents, plan.lanes(), plan.cell_bytes, memory_bytes);
  return plan;
}

int LevelPlan::held_cost_rows(int level) const {
  const int rows = extent(level).rows;
  if (!bands.has(level)) {
    return rows;
  }
  // A band, the rows around it that its iterations read, and those of the next coarser level.
  const int around = 2 * (1 + iterations) << std::max(0, bands.levels - level);
  return std::min(rows, bands.rows_of(level) + around);
}

std::size_t LevelPlan::bytes() const {
  const auto bytes_of = [this](int level, int rows, int of_lanes) {
    return static_cast<std::size_t>(extent(level).columns) * static_cast<std::size_t>(rows) *
           static_cast<std::size_t>(of_lanes * cell_bytes);
  };
  std::size_t bytes = 0;
  std::array<std::size_t, 2> results = {0, 0};  // levels share the memory of two
  for (int level = 1; level <= coarsest(); ++level) {
    const std::size_t of_costs = bytes_of(level, held_cost_rows(level), lanes());
    bytes += level == 1 && may_share_costs ? 2 * of_costs : of_costs;
    std::size_t& result = results[static_cast<std::size_t>(level) % 2];
    result = std::max(result, bytes_of(level, extent(level).rows, result_lanes(level)));
  }
  bytes += results[0] + results[1];
  if (has_windows || pruned_levels > 0) {  // winners of level 1
    bytes += static_cast<std::size_t>(extent(1).columns) *
             static_cast<std::size_t>(extent(1).rows) * sizeof(std::int32_t);
  }
  return bytes;
}

}  // namespace vantage
