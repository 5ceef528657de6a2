#include "engine/matching/search/coarse_to_fine/level_search.h"
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
  return plans_of(of_left, *prepared, executions);
}

/// Plans for the finest level of `task`, one for each of `executions`.
std::vector<scheduler::ChainPlan> StereoMatcher::plans_of(
    const MapTask& task, Prepared& prepared, std::span<const ExecutionOptions> executions) const {
  MatchReport report;  // never written
  const ImageView<float> size(nullptr, task.image->width(), task.image->height(), 1, 0);
  return LevelSearch(in_force_, prepared.parameters, execution_, prepared.levels, report)
      .plans(task.side, task.input, {.disparity_px = size}, executions);
}

}  // namespace vantage
