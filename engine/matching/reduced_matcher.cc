#include "engine/matching/reduced_matcher.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/levels/level_extents.h"
#include "engine/matching/stage_clock.h"
#include "engine/matching/windows/window_level.h"
#include "engine/refinement/enlarged_map.h"
#include "kernels/census/census.h"
#include "scheduler/trace.h"

namespace vantage {
namespace {

/// Level of the reduced images at which the search of all candidates ends.
constexpr int kSearchLevel = 1;
constexpr int kMinReducedPx = 16;

ResolvedMatchOptions at_reduction(const ResolvedMatchOptions& options, DisparityRange whole_range,
                                  int reductions) {
  ResolvedMatchOptions result = options;
  const double unit = 1 << reductions;
  result.disparities = {static_cast<int>(std::floor(whole_range.min / unit)),
                        static_cast<int>(std::ceil(whole_range.max / unit))};
  return result;
}

/// The range without disparities that no pixel can have.
DisparityRange possible_range(const ResolvedMatchOptions& options, const Photograph& image) {
  const auto geometry = candidate_geometry(options, Side::kLeft, image.width(), image.height());
  return {geometry.disparity_min, geometry.disparity_min + geometry.count - 1};
}

/// What is computed of each level to write some tiles of the map.
struct ReducedParts {
  SearchedParts search;
  std::vector<scheduler::Region> coarse_windows;  ///< of the level of windows before the map's
  std::vector<scheduler::Region> maps;
};

/// plan: of the last search of the reduced images.
ReducedParts parts_of(const TileMask& tiles, const LevelPlan& plan, int reductions,
                      const MethodParameters& parameters) {
  const scheduler::Extent searched = plan.extent(0);
  const scheduler::Extent level = coarser_extent(searched);
  const int columns_per_column = 1 << reductions;
  const int reach = coarse_reach(parameters.final_iterations);
  ReducedParts parts;
  parts.maps = tiles.regions();
  TileMask winners;
  if (reductions == 1) {
    winners = tiles.widened(level, columns_per_column, reach, kPartSidePx);
  } else {
    const TileMask windows = tiles.widened(searched, 2, reach, kPartSidePx);
    parts.coarse_windows = windows.regions();
    winners = windows.widened(level, 2, reach, kPartSidePx);
  }
  TileMask costs = tiles.widened(level, columns_per_column, 0, kPartSidePx);
  parts.search.levels = {{.costs = costs.regions(), .winners = winners.regions()}};
  // Level 2 is so small that parts of its search would take longer than all of it.
  for (int coarser = 2; coarser <= plan.coarsest(); ++coarser) {
    costs = costs.widened(plan.extent(coarser), 2, 0, kPartSidePx);
    parts.search.levels.push_back(
        {.costs = costs.regions(), .winners = {}, .has_all_winners = true});
  }
  return parts;
}

/// Refinement of maps of half the size, whose columns are two pixels wide.
RefinementOptions at_half_size(const RefinementOptions& options) {
  RefinementOptions result = options;
  result.speckle_size_px = (options.speckle_size_px + 3) / 4;
  result.surface_fit_px = (options.surface_fit_px + 1) / 2;
  result.surface_fit_step_px = 1;
  return result;
}

}  // namespace

int search_reductions(const ResolvedMatchOptions& options, scheduler::Extent image) {
  int reductions = 0;
  switch (options.parameters.search_size) {
    case SearchSize::kFull:
      break;
    case SearchSize::kHalf:
      reductions = 1;
      break;
    case SearchSize::kQuarter:
      reductions = 2;
      break;
    case SearchSize::kAuto:
      for (int candidates = options.disparities.count();
           candidates > kMaxFullSizeCandidates && reductions < 2;
           candidates = (candidates + 7) / 8) {
        ++reductions;
      }
      break;
  }
  while (reductions > 0 && std::min(image.columns, image.rows) >> reductions < kMinReducedPx) {
    --reductions;
  }
  return reductions;
}

ResolvedMatchOptions reduced_options(const ResolvedMatchOptions& options,
                                     DisparityRange whole_range, int reductions) {
  ResolvedMatchOptions result = at_reduction(options, whole_range, reductions);
  result.parameters.search_size = SearchSize::kFull;
  result.parameters.window_levels = 0;  // ReducedMatcher has its own
  result.parameters.slant_penalty *= 1 << reductions;
  return result;
}

void ReducedMatcher::prepare_costs(int reductions, Work& work) const {
  work.costs.resize(static_cast<std::size_t>(reductions) + 1);
  const DisparityRange range = possible_range(options_, work.images[0].reduced(0));
  for (int r = 0; r <= reductions; ++r) {
    const ResolvedMatchOptions options = at_reduction(options_, range, r);
    const Photograph& left_image = work.images[0].reduced(r);
    const auto geometry =
        candidate_geometry(options, Side::kLeft, left_image.width(), left_image.height());
    const bool is_searched = r == reductions;
    const auto margins = is_searched ? geometry : window_margins(geometry);
    auto& costs = work.costs[static_cast<std::size_t>(r)];
    costs[0].prepare(left_image, options_.parameters, margins, {true, false, true}, execution_);
    costs[1].prepare(work.images[1].reduced(r), options_.parameters, margins,
                     {true, is_searched, !is_searched}, execution_);
  }
}

void ReducedMatcher::compute(Side side, int reductions, bool wants_confidence,
                             const TileMask* tiles, CostSharing sharing, CoarseLevels& levels,
                             Work& work, MatchedMap& half, MatchReport& report) const {
  const std::size_t own = index_of(side);
  const std::size_t other = index_of(other_side(side));
  const DisparityRange range = possible_range(options_, work.images[own].reduced(0));
  const ResolvedMatchOptions search = reduced_options(options_, range, reductions);
  const Photograph& searched = work.images[own].reduced(reductions);
  const auto& costs = work.costs[static_cast<std::size_t>(reductions)];
  ChainInput input{nullptr, &costs[own], {CostPartner{&costs[other]}}};
  const scheduler::Extent size_px{searched.width(), searched.height()};
  input.sharing = shares_costs(search.parameters, input, size_px,
                               candidate_count(search.disparities, search.parameters))
                      ? sharing
                      : CostSharing::kNone;
  input.edges = work.search_edges.prepare(searched, search.parameters, execution_);
  // Only the size counts.
  const ImageView<float> size(nullptr, searched.width(), searched.height(), 1, 0);
  ReducedParts parts;
  if (tiles != nullptr) {
    parts = parts_of(*tiles, levels.plan(), reductions, options_.parameters);
  }
  LevelSearch(search, search.parameters, execution_, levels, report)
      .compute(side, input,
               {.outputs = {.disparity_px = size},
                .coarse = {.level = kSearchLevel, .winners = &work.winners, .is_only = true},
                .parts = tiles != nullptr ? &parts.search : nullptr});

  const auto searched_geometry =
      candidate_geometry(search, side, searched.width(), searched.height());
  const EnergyFormat format(search.parameters);
  const LevelBeliefs of_search(levels.result(kSearchLevel), levels.blocks(kSearchLevel),
                               std::as_const(work.winners).view(), searched_geometry,
                               format.of_result().nats(format.steps_per_nat()));
  std::unique_ptr<WindowBeliefs> of_windows;
  const CoarseBeliefs* coarse = &of_search;
  for (int r = reductions - 1; r >= 0; --r) {
    const Photograph& compared = work.images[own].reduced(r);
    const Photograph& level = work.images[own].reduced(r + 1);
    const ResolvedMatchOptions options = at_reduction(options_, range, r);
    auto geometry = candidate_geometry(options, side, compared.width(), compared.height());
    // Not before the coarser level's range, which the width of its image may have cut.
    const int before = std::max(0, 2 * coarse->disparity_min() - geometry.disparity_min);
    geometry.disparity_min += before;
    geometry.count -= before;
    const EdgeWeights* edges = nullptr;
    if (uses_edge_weights(options_.parameters)) {
      // Those of the search include the level's own.
      MethodParameters one_level = options_.parameters;
      one_level.levels = 1;
      one_level.iterations = one_level.final_iterations;
      edges = r + 1 == reductions ? &input.edges[0]
                                  : &work.window_edges.prepare(level, one_level, execution_)[0];
    }
    const bool is_last = r == 0;
    DisparityMap& disparity_px = is_last ? half.disparity_px : work.coarse_px;
    disparity_px.resize(level.width(), level.height());
    if (is_last) {
      half.confidence.resize(wants_confidence ? level.width() : 0,
                             wants_confidence ? level.height() : 0);
    }
    MethodParameters parameters = at_level(options_.parameters, 1);
    parameters.iterations = options_.parameters.final_iterations;
    WindowState& state = work.states[static_cast<std::size_t>(r % 2)];
    const auto& compared_costs = work.costs[static_cast<std::size_t>(r)];
    const scheduler::Span span("windows");
    search_windows({.parameters = parameters,
                    .geometry = geometry,
                    .reference = compared_costs[own],
                    .partner = compared_costs[other],
                    .edges = edges,
                    .coarse = *coarse},
                   options_.parameters.subpixel,
                   {.disparity_px = disparity_px.view(),
                    .confidence = is_last ? half.confidence.view() : ImageView<float>(),
                    .state = is_last ? nullptr : &state,
                    .regions = tiles == nullptr ? nullptr
                               : is_last        ? &parts.maps
                                                : &parts.coarse_windows},
                   execution_);
    const double share = is_last && tiles != nullptr ? tiles->share() : 1;
    const double pixels = share * level.width() * level.height();
    report.cells += pixels * kernels::kWindowCandidates;
    if (is_last) {
      report.finest_cells += pixels * kernels::kWindowCandidates;
      report.finest_pixels += pixels;
    } else {
      of_windows = std::make_unique<WindowBeliefs>(state);
      coarse = of_windows.get();
    }
  }
}

void ReducedMatcher::compute_changed(Side side, int reductions, bool wants_confidence,
                                     PreviousMaps& previous, Work& work,
                                     MatchReport& report) const {
  PreviousMaps::OfSide& kept = previous.of(side);
  compute(side, reductions, wants_confidence, previous.searched_tiles(side), CostSharing::kNone,
          kept.levels, work, kept.winners, report);
  report.searched_share = std::max(report.searched_share.value_or(0), kept.searched.share());
  copy_winners(kept.winners, execution_, work.halves.of(side));
}

void ReducedMatcher::refine(const Outputs& outputs, PreviousMaps* previous, Work& work,
                            StageClock& clock) const {
  if (!options_.refinement) {
    mark_unknown(work.halves.left.disparity_px.view(), execution_, work.halves.left.unmatched);
    mark_unknown(work.halves.right.disparity_px.view(), execution_, work.halves.right.unmatched);
    return;
  }
  const auto to_refine = [&](Side side, bool is_result) {
    return MapToRefine{.side = side,
                       .image = &work.images[index_of(side)].reduced(1),
                       .map = &work.halves.of(side),
                       .is_result = is_result,
                       .search = options_.disparities,
                       .pixels_per_column = 2,
                       .kept = previous != nullptr ? &previous->of(side).refinement : nullptr};
  };
  const MapToRefine left = to_refine(Side::kLeft, outputs.left);
  const MapToRefine right = to_refine(Side::kRight, outputs.right);
  refine_maps(at_half_size(*options_.refinement), left, &right, execution_, work.refinement,
              [&](std::string_view step) { clock.start(step); });
}

void ReducedMatcher::match(const Photograph& left, const Photograph& right, const Outputs& outputs,
                           PreviousMaps* previous, DeferredMatch* deferred, DisparityMaps& maps,
                           StageClock& clock, MatchReport& report) const {
  const int reductions = search_reductions(options_, {left.width(), left.height()});
  const auto loan = works_.borrow();
  Work& work = *loan;
  if (previous == nullptr && deferred != nullptr && deferred->is_pending) {
    std::swap(work.images, *std::exchange(*deferred, {}).images);
  } else {
    work.images[0].prepare(left, reductions, execution_);
    work.images[1].prepare(right, reductions, execution_);
  }
  const bool is_checked = options_.refinement && options_.refinement->cross_check;
  const bool wants_confidence =
      outputs.confidence || (options_.refinement && uses_confidence(*options_.refinement));
  if (previous != nullptr) {
    clock.start("changes");
    const Photograph& half = work.images[0].reduced(1);
    const std::uint32_t wanted =
        (outputs.left || is_checked ? 1U : 0U) | (outputs.right || is_checked ? 2U : 0U) |
        (outputs.left ? 4U : 0U) | (outputs.right ? 8U : 0U) | (wants_confidence ? 16U : 0U);
    if (!previous->choose(half, work.images[1].reduced(1),
                          {{half.width(), half.height()}, wanted})) {
      previous = nullptr;
      report.searched_share = 1;
      if (deferred != nullptr) {
        *deferred = {.is_pending = true, .images = lend_images()};
        std::swap(work.images, *deferred->images);
        return;
      }
    }
    clock.start("prepare");
  }
  prepare_costs(reductions, work);
  const bool has_both = is_checked || (outputs.left && outputs.right);
  for (const Side side : {Side::kLeft, Side::kRight}) {
    MatchedMap& half = work.halves.of(side);
    half.disparity_px.resize(0, 0);
    if (!((side == Side::kLeft ? outputs.left : outputs.right) || is_checked)) {
      continue;
    }
    clock.start(side == Side::kLeft ? "match left" : "match right");
    if (previous != nullptr) {
      compute_changed(side, reductions, wants_confidence, *previous, work, report);
    } else {
      const CostSharing sharing = !has_both             ? CostSharing::kNone
                                  : side == Side::kLeft ? CostSharing::kStores
                                                        : CostSharing::kUses;
      compute(side, reductions, wants_confidence, nullptr, sharing, work.levels, work, half,
              report);
    }
  }
  refine(outputs, previous, work, clock);
  clock.start("enlarge");
  for (const Side side : {Side::kLeft, Side::kRight}) {
    MatchedMap& map = maps.of(side);
    if (!(side == Side::kLeft ? outputs.left : outputs.right)) {
      map = {};
      continue;
    }
    const ReducedImages& images = work.images[index_of(side)];
    enlarge_map(work.halves.of(side), images.reduced(0), images.reduced(1), execution_, map);
    if (!outputs.confidence) {
      map.confidence.resize(0, 0);
    }
  }
}

std::shared_ptr<DeferredMatch::Images> ReducedMatcher::lend_images() const {
  using Loan = ObjectPool<DeferredMatch::Images>::Loan;
  const std::shared_ptr<Loan> loan(new Loan(deferred_images_.borrow()));
  return {loan, &**loan};
}

std::size_t ReducedMatcher::deferred_bytes(const ResolvedMatchOptions& options,
                                           scheduler::Extent image) {
  std::size_t bytes = 0;
  for (int r = 0; r <= search_reductions(options, image); ++r) {
    bytes += 2 * static_cast<std::size_t>(image.columns) * static_cast<std::size_t>(image.rows);
    image = coarser_extent(image);
  }
  return bytes;
}

std::size_t ReducedMatcher::working_bytes(const ResolvedMatchOptions& options,
                                          scheduler::Extent image) {
  // Of both images at all sizes: intensities with and without margins, codes and, at most, mirrored
  // ones. Of both maps at half size: disparities, masks, what refinement keeps.
  constexpr std::size_t kBytesPerPixel = 2 * (2 + 2 * kernels::kRayCensusBytes);
  constexpr std::size_t kBytesPerHalfSizePixel = 2 * (sizeof(float) + 1) + 4 * sizeof(float);
  const int reductions = search_reductions(options, image);
  std::size_t bytes = 0;
  scheduler::Extent extent = image;
  for (int r = 0; r <= reductions; ++r) {
    const std::size_t pixels =
        static_cast<std::size_t>(extent.columns) * static_cast<std::size_t>(extent.rows);
    bytes += kBytesPerPixel * pixels + (r == 1 ? kBytesPerHalfSizePixel * pixels : 0);
    if (r > 0) {
      bytes += edge_weight_bytes(options.parameters, pixels);
    }
    extent = coarser_extent(extent);
  }
  return bytes + level_bytes(options, image);
}

std::size_t ReducedMatcher::level_bytes(const ResolvedMatchOptions& options,
                                        scheduler::Extent image, std::size_t memory_bytes) {
  const int reductions = search_reductions(options, image);
  for (int r = 0; r < reductions; ++r) {
    image = coarser_extent(image);
  }
  return level_plan(options.parameters, image, (options.disparities.count() >> reductions) + 2,
                    memory_bytes)
      .bytes();
}

void ReducedMatcher::add_memory_use(MemoryUse& use) const {
  deferred_images_.for_each_idle([&use](const DeferredMatch::Images& images) {
    use.add("prepared images", images[0].held_bytes() + images[1].held_bytes());
  });
  works_.for_each_idle([&use](const Work& work) {
    std::size_t images = work.search_edges.held_bytes() + work.window_edges.held_bytes();
    for (const ReducedImages& of_side : work.images) {
      images += of_side.held_bytes();
    }
    for (const auto& costs : work.costs) {
      images += costs[0].held_bytes() + costs[1].held_bytes();
    }
    use.add("prepared images", images);
    use.add("coarse levels", work.levels.held_bytes() + work.states[0].held_bytes() +
                                 work.states[1].held_bytes() + held_bytes(work.halves));
    use.add("refinement", held_bytes(work.refinement));
  });
}

}  // namespace vantage
