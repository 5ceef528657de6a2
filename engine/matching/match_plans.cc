#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/levels/level_extents.h"
#include "engine/matching/stereo_matcher_parts.h"

// Execution plans of StereoMatcher.

namespace vantage {

scheduler::ChainPlan StereoMatcher::plan(const Photograph& left, const Photograph& right) const {
  return plans(left, right, {&execution_.options(), 1}).front();
}

std::vector<scheduler::ChainPlan> StereoMatcher::plans(
    const Photograph& left, const Photograph& right,
    std::span<const ExecutionOptions> executions) const {
  require_equal_sizes(left, "left image", right, "right image");
  const auto prepared = parts_->prepared.borrow();
  prepared->parameters = in_force_.parameters;
  prepared->of_right = {};
  DisparityMaps maps;  // never read
  MapTask of_left{.side = Side::kLeft, .image = &left, .map = &maps.left};
  MapTask of_right{.side = Side::kRight, .image = &right, .map = &maps.right};
  of_left.need = {.whole = true};
  prepare_inputs(of_left, of_right, false, *prepared);
  auto geometry = candidate_geometry(in_force_, Side::kLeft, left.width(), left.height());
  maps.left.disparity_px.resize(left.width(), left.height());
  const auto grid = displacement_grid(in_force_, Side::kLeft, left.width(), left.height());
  if (grid) {
    of_left.input.grid = &*grid;
    geometry = grid->columns();
  }
  return plans_of(in_force_.parameters, of_left, geometry, executions);
}

/// Plans for the finest level of `task`, one for each of `executions`.
std::vector<scheduler::ChainPlan> StereoMatcher::plans_of(
    const MethodParameters& parameters, const MapTask& task,
    const kernels::CandidateGeometry& geometry,
    std::span<const ExecutionOptions> executions) const {
  const LevelVolume coarser;  // never read
  const auto extents =
      level_extents({task.image->width(), task.image->height()}, parameters.levels);
  const bool has_windows = parameters.window_levels > 0 && extents.size() > 1;
  LevelVolume costs;        // never written
  LevelVolume right_costs;  // likewise
  const bool is_pruned = !has_windows && parameters.candidate_blocks > 0 && extents.size() > 1;
  CandidateBlocks blocks;
  if (is_pruned) {
    blocks.resize(extents.front(), geometry.count, parameters.candidate_blocks,
                  geometry.steps_per_px);
  }
  const MatchChain chain(
      parameters, geometry, task.input, {.disparity_px = task.map->disparity_px.view()},
      has_windows ? ChainLevel{.reduced = &costs,
                               .reduced_right = shares_costs(parameters, task.input,
                                                             extents.front(), geometry.count)
                                                    ? &right_costs
                                                    : nullptr}
                  : ChainLevel{.coarser = extents.size() > 1 ? &coarser : nullptr,
                               .blocks = is_pruned ? &blocks : nullptr});
  std::vector<scheduler::ChainPlan> plans;
  for (const ExecutionOptions& execution : executions) {
    plans.push_back(chain_plan(chain, execution, thread_count(execution, execution_.machine()),
                               execution_.machine()));
  }
  return plans;
}

}  // namespace vantage
