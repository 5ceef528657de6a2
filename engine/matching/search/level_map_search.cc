#include "engine/matching/search/level_map_search.h"

#include <algorithm>
#include <utility>

#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/search/coarse_to_fine/level_search.h"

namespace vantage {

void LevelMemory::add_use(MemoryUse& use) const {
  std::size_t bytes = edges.held_bytes();
  for (const CostImage& image : images) {
    bytes += image.held_bytes();
  }
  for (const std::size_t i : {0, 1}) {
    bytes += held_bytes(check_px[i]);
  }
  use.add("prepared images", bytes);
  use.add("coarse levels", levels.held_bytes());
}

LevelMapSearch::Targets LevelMapSearch::targets_of(const MapTask& task,
                                                   PreviousMaps::OfSide* kept) {
  if (kept != nullptr) {
    return {kept->winners, kept->check_px, kept->levels};
  }
  const std::size_t side = index_of(task.side);
  return {*task.map, memory_.check_px[side], memory_.levels};
}

void LevelMapSearch::resize(const MapTask& task, const Targets& targets) const {
  const auto resize = [&](Image<float>& image, bool is_wanted) {
    image.resize(is_wanted ? task.image->width() : 0, is_wanted ? task.image->height() : 0);
  };
  const bool is_whole = task.need.whole;
  resize(targets.map.disparity_px, is_whole);
  resize(targets.map.confidence, is_whole && task.wants_confidence);
  resize(targets.map.disparity_y_px, is_whole && job_.options.disparities_y);
  resize(targets.check_px, task.need.check && !task.need.check_is_only);
}

WantedWinners LevelMapSearch::wanted_of(MapTask& task, const Targets& targets) const {
  // Without a map of its own only the size is used.
  const ImageView<float> size_alone(nullptr, task.image->width(), task.image->height(), 1, 0);
  WantedWinners wanted{
      .outputs = {.disparity_px = task.need.whole ? targets.map.disparity_px.view() : size_alone,
                  .confidence = targets.map.confidence.view(),
                  .disparity_y_px = targets.map.disparity_y_px.view()}};
  if (task.need.check) {
    const bool is_only = task.need.check_is_only;
    wanted.check = {.disparity_px = (is_only ? targets.map.disparity_px : targets.check_px).view(),
                    .is_only = is_only};
    task.check_px = wanted.check.disparity_px;
  }
  return wanted;
}

void LevelMapSearch::search_levels(MapTask& task, const ChainInput& prepared) {
  PreviousMaps::OfSide* const kept =
      job_.previous != nullptr ? &job_.previous->of(task.side) : nullptr;
  const Targets targets = targets_of(task, kept);
  resize(task, targets);
  if (!task.need.whole) {
    return;
  }
  ChainInput input = prepared;
  input.edges = memory_.edges.prepare(*task.image, job_.parameters, job_.execution);
  WantedWinners wanted = wanted_of(task, targets);
  const TileMask* const tiles =
      kept != nullptr ? job_.previous->searched_tiles(task.side) : nullptr;
  SearchedParts parts;
  if (tiles != nullptr) {
    parts = searched_parts(*tiles, targets.levels.plan(), job_.parameters);
    wanted.parts = &parts;
  }
  LevelSearch(job_.options, job_.parameters, job_.execution, targets.levels, job_.report)
      .compute(task.side, input, wanted, task.volumes);
  if (kept != nullptr) {
    job_.report.count_searched(kept->searched.share());
    if (!task.need.check_is_only) {
      copy_winners(kept->winners, job_.execution, *task.map);
    }
  }
}

void LevelMapSearch::add_prior(Side side, ChainInput& input) const {
  const DisparityPrior& prior = job_.request.prior;
  if (job_.request.uses_prior()) {
    input.prior_px = side == Side::kLeft ? prior.left_px : prior.right_px;
    input.prior_weight = prior.weight;
  }
}

std::vector<scheduler::ChainPlan> LevelMapSearch::plans(
    const MapTask& task, std::span<const ExecutionOptions> executions) {
  const ImageView<float> size(nullptr, task.image->width(), task.image->height(), 1, 0);
  return LevelSearch(job_.options, job_.parameters, job_.execution, memory_.levels, job_.report)
      .plans(task.side, input_of(task), {.disparity_px = size}, executions);
}

MapToRefine LevelMapSearch::to_refine(const MapTask& task) const {
  return {.side = task.side,
          .image = task.image,
          .map = task.map,
          .check_px = task.check_px,
          .is_result = task.is_result,
          .search = job_.options.disparities,
          .search_y = job_.options.disparities_y.value_or(kAnyDisparity),
          .kept = job_.previous != nullptr ? &job_.previous->of(task.side).refinement : nullptr};
}

void LevelMapSearch::mark_all_unknown() const {
  for (const MapTask& task : job_.tasks) {
    if (job_.request.unmatched) {
      mark_unknown(std::as_const(task.map->disparity_px).view(), job_.execution,
                   task.map->unmatched);
    }
  }
}

}  // namespace vantage
