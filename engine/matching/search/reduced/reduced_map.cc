#include "engine/matching/search/reduced/reduced_map.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/level_extents.h"
#include "engine/matching/search/coarse_to_fine/level_search.h"
#include "engine/matching/search/reduced/reduction.h"
#include "engine/matching/windows/window_level.h"
#include "scheduler/trace.h"

namespace vantage {
namespace {

/// Level of the reduced images at which the search of all candidates ends.
constexpr int kSearchLevel = 1;

}  // namespace

void ReducedMemory::add_use(MemoryUse& use) const {
  std::size_t bytes = search_edges.held_bytes() + window_edges.held_bytes();
  for (const ReducedImages& of_side : images) {
    bytes += of_side.held_bytes();
  }
  for (const auto& of_size : costs) {
    bytes += of_size[0].held_bytes() + of_size[1].held_bytes();
  }
  use.add("prepared images", bytes);
  use.add("coarse levels", levels.held_bytes() + states[0].held_bytes() + states[1].held_bytes() +
                               held_bytes(halves));
}

ReducedMap::ReducedMap(SearchJob& job, Side side, DisparityRange range, ReducedMemory& memory,
                       CoarseLevels& levels, const TileMask* tiles)
    : job_(job),
      side_(side),
      own_(index_of(side)),
      range_(range),
      memory_(memory),
      levels_(levels),
      tiles_(tiles),
      search_(reduced_options(job.options, range, job.plan.reductions)) {
  if (tiles == nullptr) {
    return;
  }
  const LevelPlan& plan = levels.plan();
  const scheduler::Extent level = coarser_extent(plan.extent(0));
  const int columns_per_column = 1 << job.plan.reductions;
  const int reach = coarse_reach(job.options.parameters.final_iterations);
  map_ = tiles->regions();
  TileMask winners;
  if (job.plan.reductions == 1) {
    winners = tiles->widened(level, columns_per_column, reach, kPartSidePx);
  } else {
    const TileMask windows = tiles->widened(plan.extent(0), 2, reach, kPartSidePx);
    coarse_windows_ = windows.regions();
    winners = windows.widened(level, 2, reach, kPartSidePx);
  }
  TileMask costs = tiles->widened(level, columns_per_column, 0, kPartSidePx);
  parts_.levels = {{.costs = costs.regions(), .winners = winners.regions()}};
  // Level 2 is so small that parts of its search would take longer than all of it.
  for (int coarser = 2; coarser <= plan.coarsest(); ++coarser) {
    costs = costs.widened(plan.extent(coarser), 2, 0, kPartSidePx);
    parts_.levels.push_back({.costs = costs.regions(), .winners = {}, .has_all_winners = true});
  }
}

void ReducedMap::compute(CostSharing sharing, bool wants_confidence, MatchedMap& half) {
  const int reductions = job_.plan.reductions;
  half.disparity_px.resize(image_at(1).width(), image_at(1).height());
  half.confidence.resize(wants_confidence ? image_at(1).width() : 0,
                         wants_confidence ? image_at(1).height() : 0);
  search_all_candidates(sharing);
  const Photograph& searched = image_at(reductions);
  const auto geometry = candidate_geometry(search_, side_, searched.width(), searched.height());
  const EnergyFormat format(search_.parameters);
  const LevelBeliefs of_search(levels_.result(kSearchLevel), levels_.blocks(kSearchLevel),
                               std::as_const(memory_.winners).view(), geometry,
                               format.of_result().nats(format.steps_per_nat()));
  std::optional<WindowBeliefs> of_windows;
  for (int r = reductions - 1; r >= 0; --r) {
    const scheduler::Span span("windows");
    search_windows_at(r, of_windows ? static_cast<const CoarseBeliefs&>(*of_windows) : of_search,
                      half);
    count(r);
    of_windows.emplace(memory_.states[static_cast<std::size_t>(r % 2)]);
  }
}

void ReducedMap::search_all_candidates(CostSharing sharing) {
  const Photograph& searched = image_at(job_.plan.reductions);
  const auto& costs = memory_.costs[static_cast<std::size_t>(job_.plan.reductions)];
  ChainInput input{nullptr, &costs[own_], {CostPartner{&costs[1 - own_]}}};
  if (shares_costs(search_.parameters, input, {searched.width(), searched.height()},
                   candidate_count(search_.disparities, search_.parameters))) {
    input.sharing = sharing;
  }
  edges_ = memory_.search_edges.prepare(searched, search_.parameters, job_.execution);
  input.edges = edges_;
  // Only the size counts.
  const ImageView<float> size(nullptr, searched.width(), searched.height(), 1, 0);
  LevelSearch(search_, search_.parameters, job_.execution, levels_, job_.report)
      .compute(side_, input,
               {.outputs = {.disparity_px = size},
                .coarse = {.level = kSearchLevel, .winners = &memory_.winners},
                .parts = tiles_ != nullptr ? &parts_ : nullptr});
}

/// The level of windows that compares images halved so many times, at half their size.
void ReducedMap::search_windows_at(int reductions, const CoarseBeliefs& coarse, MatchedMap& half) {
  const Photograph& compared = image_at(reductions);
  const ResolvedMatchOptions options = at_reduction(job_.options, range_, reductions);
  auto geometry = candidate_geometry(options, side_, compared.width(), compared.height());
  // Not before the coarser level's range, which the width of its image may have cut.
  const int before = std::max(0, 2 * coarse.disparity_min() - geometry.disparity_min);
  geometry.disparity_min += before;
  geometry.count -= before;
  const bool is_last = reductions == 0;
  const Photograph& level = image_at(reductions + 1);
  if (!is_last) {
    memory_.coarse_px.resize(level.width(), level.height());
  }
  MethodParameters parameters = at_level(job_.options.parameters, 1);
  parameters.iterations = job_.options.parameters.final_iterations;
  const auto& costs = memory_.costs[static_cast<std::size_t>(reductions)];
  search_windows(
      {.parameters = parameters,
       .geometry = geometry,
       .reference = costs[own_],
       .partner = costs[1 - own_],
       .edges = edges_at(reductions),
       .coarse = coarse},
      job_.options.parameters.subpixel,
      {.disparity_px = (is_last ? half.disparity_px : memory_.coarse_px).view(),
       .confidence = is_last ? half.confidence.view() : ImageView<float>(),
       .state = is_last ? nullptr : &memory_.states[static_cast<std::size_t>(reductions % 2)],
       .regions = regions_at(reductions)},
      job_.execution);
}

/// The weights for that level of windows.
const EdgeWeights* ReducedMap::edges_at(int reductions) {
  if (!uses_edge_weights(job_.options.parameters)) {
    return nullptr;
  }
  if (reductions + 1 == job_.plan.reductions) {
    return edges_.data();  // those of the search include the level's own
  }
  MethodParameters one_level = job_.options.parameters;
  one_level.levels = 1;
  one_level.iterations = one_level.final_iterations;
  return memory_.window_edges.prepare(image_at(reductions + 1), one_level, job_.execution).data();
}

const std::vector<scheduler::Region>* ReducedMap::regions_at(int reductions) const {
  if (tiles_ == nullptr) {
    return nullptr;
  }
  return reductions == 0 ? &map_ : &coarse_windows_;
}

void ReducedMap::count(int reductions) {
  const bool is_last = reductions == 0;
  const Photograph& level = image_at(reductions + 1);
  const double share = is_last && tiles_ != nullptr ? tiles_->share() : 1;
  const double pixels = share * level.width() * level.height();
  job_.report.cells += pixels * kernels::kWindowCandidates;
  if (is_last) {
    job_.report.finest_cells += pixels * kernels::kWindowCandidates;
    job_.report.finest_pixels += pixels;
  }
}

}  // namespace vantage
