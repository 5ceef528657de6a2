#include "engine/matching/search/reduced/reduced_search.h"

#include <memory>
#include <utility>

#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/levels/level_extents.h"
#include "engine/matching/search/reduced/reduction.h"
#include "engine/matching/windows/window_level.h"
#include "engine/refinement/enlarged_map.h"
#include "kernels/census/census.h"

namespace vantage {
namespace {

/// Refinement of maps of half the size, whose columns are two pixels wide.
RefinementOptions at_half_size(const RefinementOptions& options) {
  RefinementOptions result = options;
  result.speckle_size_px = (options.speckle_size_px + 3) / 4;
  result.surface_fit_px = (options.surface_fit_px + 1) / 2;
  result.surface_fit_step_px = 1;
  return result;
}

}  // namespace

SearchPlan ReducedSearch::plan(const ResolvedMatchOptions& options, const MatchSize& size) {
  // Of both images at all sizes: intensities with and without margins, codes and, at most, mirrored
  // ones. Of both maps at half size: disparities, masks, what refinement keeps.
  constexpr std::size_t kBytesPerPixel = 2 * (2 + 2 * kernels::kRayCensusBytes);
  constexpr std::size_t kBytesPerHalfSizePixel = 2 * (sizeof(float) + 1) + 4 * sizeof(float);
  SearchPlan plan;
  plan.reductions = search_reductions(options, size.image);
  scheduler::Extent extent = size.image;
  for (int r = 0;; ++r) {
    const std::size_t pixels =
        static_cast<std::size_t>(extent.columns) * static_cast<std::size_t>(extent.rows);
    plan.image_bytes += kBytesPerPixel * pixels;
    plan.deferred_bytes += 2 * pixels;
    plan.map_bytes += r == 1 ? kBytesPerHalfSizePixel * pixels : 0;
    plan.edge_bytes += r > 0 ? edge_weight_bytes(options.parameters, pixels) : 0;
    if (r == plan.reductions) {
      break;
    }
    extent = coarser_extent(extent);
  }
  plan.levels = level_plan(options.parameters, extent,
                           (options.disparities.count() >> plan.reductions) + 2, size.level_bytes);
  return plan;
}

void ReducedSearch::start() {
  for (const std::size_t i : {0, 1}) {
    memory_.images[i].prepare(*job_.images[i].photograph, job_.plan.reductions, job_.execution);
  }
  add_tasks();
}

void ReducedSearch::resume(DeferredMatch& deferred) {
  std::swap(memory_.images, *std::exchange(deferred, {}).images);
  add_tasks();
}

void ReducedSearch::defer(DeferredMatch& deferred) {
  const std::shared_ptr<ImagePool::Loan> loan(new ImagePool::Loan(lent_.borrow()));
  deferred = {.is_pending = true, .images = {loan, &**loan}};
  std::swap(memory_.images, *deferred.images);
}

void ReducedSearch::add_tasks() {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    job_.tasks.push_back({.side = side,
                          .image = &memory_.images[index_of(side)].reduced(1),
                          .map = &memory_.halves.of(side),
                          .name = side == Side::kLeft ? "match left" : "match right",
                          .is_result = job_.request.wants(side),
                          .wants_confidence = job_.wants_confidence()});
  }
}

std::array<const Photograph*, 2> ReducedSearch::half_size_images() {
  return {&memory_.images[0].reduced(1), &memory_.images[1].reduced(1)};
}

void ReducedSearch::prepare() {
  const Photograph& left = memory_.images[0].reduced(0);
  const auto possible = candidate_geometry(job_.options, Side::kLeft, left.width(), left.height());
  range_ = {possible.disparity_min, possible.disparity_min + possible.count - 1};
  const int reductions = job_.plan.reductions;
  memory_.costs.resize(static_cast<std::size_t>(reductions) + 1);
  for (int r = 0; r <= reductions; ++r) {
    const ResolvedMatchOptions options = at_reduction(job_.options, range_, r);
    const Photograph& image = memory_.images[0].reduced(r);
    const auto geometry = candidate_geometry(options, Side::kLeft, image.width(), image.height());
    const bool is_searched = r == reductions;
    const auto margins = is_searched ? geometry : window_margins(geometry);
    auto& costs = memory_.costs[static_cast<std::size_t>(r)];
    costs[0].prepare(image, job_.options.parameters, margins, {true, false, true}, job_.execution);
    costs[1].prepare(memory_.images[1].reduced(r), job_.options.parameters, margins,
                     {true, is_searched, !is_searched}, job_.execution);
  }
}

CostSharing ReducedSearch::sharing_of(Side side) const {
  if (job_.previous != nullptr || !job_.tasks[0].need.whole || !job_.tasks[1].need.whole) {
    return CostSharing::kNone;
  }
  return side == Side::kLeft ? CostSharing::kStores : CostSharing::kUses;
}

void ReducedSearch::search(MapTask& task) {
  MatchedMap& half = *task.map;
  half.disparity_px.resize(0, 0);
  if (!task.need.whole) {
    return;
  }
  if (job_.previous == nullptr) {
    ReducedMap(job_, task.side, range_, memory_, memory_.levels, nullptr)
        .compute(sharing_of(task.side), task.wants_confidence, half);
    return;
  }
  PreviousMaps::OfSide& kept = job_.previous->of(task.side);
  ReducedMap(job_, task.side, range_, memory_, kept.levels,
             job_.previous->searched_tiles(task.side))
      .compute(CostSharing::kNone, task.wants_confidence, kept.winners);
  job_.report.count_searched(kept.searched.share());
  copy_winners(kept.winners, job_.execution, half);
}

void ReducedSearch::refine_halves(RefinementWork& work) {
  if (!job_.options.refinement) {
    for (const MapTask& task : job_.tasks) {
      mark_unknown(std::as_const(task.map->disparity_px).view(), job_.execution,
                   task.map->unmatched);
    }
    return;
  }
  const auto to_refine = [this](const MapTask& task) {
    return MapToRefine{
        .side = task.side,
        .image = task.image,
        .map = task.map,
        .is_result = task.is_result,
        .search = job_.options.disparities,
        .pixels_per_column = 2,
        .kept = job_.previous != nullptr ? &job_.previous->of(task.side).refinement : nullptr};
  };
  const MapToRefine left = to_refine(job_.tasks[0]);
  const MapToRefine right = to_refine(job_.tasks[1]);
  refine_maps(at_half_size(*job_.options.refinement), left, &right, job_.execution, work,
              [this](std::string_view step) { job_.clock.start(step); });
}

void ReducedSearch::refine(RefinementWork& work) {
  refine_halves(work);
  job_.clock.start("enlarge");
  for (const MapTask& task : job_.tasks) {
    MatchedMap& map = job_.maps.of(task.side);
    if (!task.is_result) {
      map = {};
      continue;
    }
    const ReducedImages& images = memory_.images[index_of(task.side)];
    enlarge_map(*task.map, images.reduced(0), images.reduced(1), job_.execution, map);
    if (!job_.request.confidence) {
      map.confidence.resize(0, 0);
    }
  }
}

}  // namespace vantage
