#include "engine/matching/stereo_matcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "engine/error.h"
#include "engine/matching/costs/candidate_geometry.h"
#include "engine/matching/levels/level_extents.h"
#include "engine/matching/stage_clock.h"

namespace vantage {
namespace {

std::size_t held_bytes_of(const RefinementWork& work) {
  const EdgeSnappingWork& edges = work.edge_snapping;
  std::size_t bytes = held_bytes(edges.grey) + held_bytes(edges.smooth_x) +
                      held_bytes(edges.gradient_x) + held_bytes(edges.gradient_y) +
                      held_bytes(edges.edges) + held_bytes(work.filled_medians.before) +
                      held_bytes(work.filled_medians.pixels) +
                      held_bytes(work.surface_fit.matched_px);
  for (const SpeckleWork& speckles : work.speckles) {
    bytes += held_bytes(speckles.runs) + held_bytes(speckles.row_begin);
  }
  return bytes;
}

}  // namespace

std::size_t held_bytes(const DisparityMaps& maps) {
  std::size_t bytes = held_bytes(maps.left_unmatched) + held_bytes(maps.right_unmatched);
  for (const Image<float>* map :
       {&maps.left, &maps.right, &maps.left_confidence, &maps.right_confidence,
        &maps.left_disparity_y, &maps.right_disparity_y}) {
    bytes += held_bytes(*map);
  }
  return bytes;
}

StereoMatcher::StereoMatcher(const MatchOptions& options, Execution& execution)
    : options_(options), execution_(execution) {
  options_.validate();
  if (options_.disparities_auto || options_.disparities_y_auto) {
    throw UsageError("disparities is auto, expected the range that the images suggest");
  }
  parameters_ = options_.resolved();
  if (uses_pair_levels(parameters_)) {
    levels_ = std::make_unique<PairLevelsEstimator>(options_.disparities, execution_);
  }
}

int StereoMatcher::check_level(const RefinementOptions& refinement, scheduler::Extent image) const {
  const auto coarsest = static_cast<int>(level_extents(image, parameters_.levels).size()) - 1;
  return std::min(refinement.cross_check_level, coarsest);
}

bool StereoMatcher::wants_confidence(const MatchRequest& request) const {
  return request.confidence || (!options_.raw && uses_confidence(options_.resolved_refinement()));
}

/// What is estimated from a pair's grey levels.
void StereoMatcher::settle_levels(const Photograph& left, const Photograph& right,
                                  Prepared& prepared, MatchReport& report) const {
  // Throws for the whole images, where bands of them would be named otherwise.
  candidate_geometry(options_, Side::kLeft, left.width(), left.height());
  const PairLevels levels =
      levels_->estimate(left, right, parameters_.colour, parameters_.match_exposure);
  prepared.of_right = levels.of_right;
  if (parameters_.estimate_sigma_measurement && levels.sigma_measurement) {
    prepared.parameters.sigma_measurement = *levels.sigma_measurement;
  }
  report.levels = levels;
}

/// The same of each other image beside the reference; σ is that of the noisiest.
std::vector<LevelChanges> StereoMatcher::settle_levels(const Photograph& reference,
                                                       std::span<const OtherView> others,
                                                       Prepared& prepared,
                                                       MatchReport& report) const {
  std::vector<LevelChanges> changes;
  std::optional<double> sigma;
  for (const OtherView& other : others) {
    // In units of x_reference − x_other.
    const double ratio = other.baseline / std::abs(others.front().baseline);
    const auto [least, most] =
        std::minmax({options_.disparities.min * ratio, options_.disparities.max * ratio});
    const DisparityRange range{static_cast<int>(std::floor(least)),
                               static_cast<int>(std::ceil(most))};
    const PairLevels levels =
        PairLevelsEstimator(range, execution_)
            .estimate(reference, *other.photograph, parameters_.colour, parameters_.match_exposure);
    changes.push_back(levels.of_right);
    if (levels.sigma_measurement) {
      sigma = std::max(sigma.value_or(0), *levels.sigma_measurement);
    }
    if (!report.levels) {
      report.levels = levels;
    }
  }
  if (parameters_.estimate_sigma_measurement && sigma) {
    prepared.parameters.sigma_measurement = *sigma;
  }
  return changes;
}

/// What the chains of both maps read.
void StereoMatcher::prepare_inputs(MapTask& left, MapTask& right, bool uses_prior,
                                   Prepared& prepared) const {
  const auto is_needed = [](const MapTask& side) { return side.need.whole || side.need.coarse; };
  const bool needs_left = is_needed(left);
  const bool needs_right = is_needed(right);
  const auto geometry =
      candidate_geometry(options_, Side::kLeft, left.image->width(), left.image->height());
  if (uses_column_ssd(parameters_) && !options_.disparities_y && !uses_prior) {
    prepare_pair(*left.image, *right.image, geometry, parameters_.window_px * parameters_.window_px,
                 {needs_left, needs_right}, execution_, prepared.pair);
    left.input.pair = right.input.pair = &prepared.pair;
  } else {
    prepared.images.resize(2);
    CostImage& left_image = prepared.images[0];
    CostImage& right_image = prepared.images[1];
    left_image.prepare(*left.image, prepared.parameters, geometry, {needs_left, false, needs_right},
                       execution_);
    right_image.prepare(*right.image, prepared.parameters, geometry,
                        {needs_right, needs_left, false, prepared.of_right}, execution_);
    left.input = {nullptr, &left_image, {CostPartner{&right_image}}};
    right.input = {nullptr, &right_image, {CostPartner{&left_image}}};
  }
}

scheduler::ChainPlan StereoMatcher::plan(const Photograph& left, const Photograph& right) const {
  return plans(left, right, {&execution_.options(), 1}).front();
}

std::vector<scheduler::ChainPlan> StereoMatcher::plans(
    const Photograph& left, const Photograph& right,
    std::span<const ExecutionOptions> executions) const {
  require_equal_sizes(left, "left image", right, "right image");
  const auto prepared = prepared_.borrow();
  prepared->parameters = parameters_;
  prepared->of_right = {};
  DisparityMaps maps;  // nobody looks into them
  MapTask of_left = left_task(left, maps);
  MapTask of_right = right_task(right, maps);
  of_left.need = {.whole = true};
  prepare_inputs(of_left, of_right, false, *prepared);
  auto geometry = candidate_geometry(options_, Side::kLeft, left.width(), left.height());
  maps.left.resize(left.width(), left.height());
  const auto grid = displacement_grid(options_, Side::kLeft, left.width(), left.height());
  if (grid) {
    of_left.input.grid = &*grid;
    geometry = grid->columns();
  }
  const LevelVolume coarser;  // nobody looks into it
  const auto extents = level_extents({left.width(), left.height()}, parameters_.levels);
  const bool is_pruned = parameters_.candidate_blocks > 0 && extents.size() > 1;
  CandidateBlocks blocks;
  if (is_pruned) {
    blocks.resize(extents.front(), geometry.count, parameters_.candidate_blocks);
  }
  const MatchChain chain(parameters_, geometry, of_left.input, {.disparity_px = maps.left.view()},
                         {.coarser = extents.size() > 1 ? &coarser : nullptr,
                          .blocks = is_pruned ? &blocks : nullptr});
  std::vector<scheduler::ChainPlan> plans;
  for (const ExecutionOptions& execution : executions) {
    plans.push_back(chain_plan(chain, execution, thread_count(execution, execution_.machine()),
                               execution_.machine()));
  }
  return plans;
}

/// What is made of each image's map: all of it where it or, for a check of the other one, all of it
/// is wanted; the coarse level where the other is checked against that.
std::pair<StereoMatcher::MapNeed, StereoMatcher::MapNeed> StereoMatcher::needs(
    const MatchRequest& request, const RefinementOptions& refinement, int check_level) const {
  const bool is_checked = !options_.raw && refinement.cross_check;
  const auto need = [&](bool is_wanted, bool is_other_wanted) -> MapNeed {
    return {.whole = is_wanted || (is_checked && check_level == 0),
            .coarse = is_checked && check_level > 0 && is_other_wanted};
  };
  return {need(request.left, request.right), need(request.right, request.left)};
}

StereoMatcher::MapTask StereoMatcher::left_task(const Photograph& image, DisparityMaps& maps) {
  return {.reference = Side::kLeft,
          .image = &image,
          .px = &maps.left,
          .confidence = &maps.left_confidence,
          .disparity_y = &maps.left_disparity_y,
          .unmatched = &maps.left_unmatched};
}

StereoMatcher::MapTask StereoMatcher::right_task(const Photograph& image, DisparityMaps& maps) {
  return {.reference = Side::kRight,
          .image = &image,
          .px = &maps.right,
          .confidence = &maps.right_confidence,
          .disparity_y = &maps.right_disparity_y,
          .unmatched = &maps.right_unmatched};
}

/// Gives the side's images their sizes and computes what it needs of its map.
void StereoMatcher::compute(MapTask& side, std::string_view name, bool wants_confidence,
                            int check_level, Prepared& prepared, StageClock& clock,
                            MatchReport& report) const {
  const auto resize = [&](Image<float>& image, bool is_wanted) {
    image.resize(is_wanted ? side.image->width() : 0, is_wanted ? side.image->height() : 0);
  };
  const bool has_confidence = side.need.whole && wants_confidence;
  const bool has_disparity_y = side.need.whole && options_.disparities_y;
  DisparityMap& coarse_px = prepared.coarse_px[index_of(side.reference)];
  resize(*side.px, side.need.whole);
  resize(*side.confidence, has_confidence);
  resize(*side.disparity_y, has_disparity_y);
  resize(coarse_px, side.need.coarse);
  side.check_px = std::as_const(coarse_px).view();
  if (!side.need.whole && !side.need.coarse) {
    return;
  }
  clock.begin(name);
  side.input.edges = prepared.edges.prepare(*side.image, parameters_, execution_);
  MapResult result{.disparity_px = side.need.whole ? side.px : &coarse_px,
                   .confidence = has_confidence ? side.confidence : nullptr,
                   .disparity_y_px = has_disparity_y ? side.disparity_y : nullptr};
  if (side.need.coarse) {
    result.coarse = {
        .level = check_level, .disparity_px = coarse_px.view(), .is_all = !side.need.whole};
  }
  MapSearch(options_, prepared.parameters, execution_, prepared.search, report)
      .compute(side.reference, side.input, result);
}

MapToRefine StereoMatcher::to_refine(const MapTask& side, bool is_result) const {
  return {.side = side.reference,
          .image = side.image,
          .disparity_px = side.need.whole ? side.px : nullptr,
          .disparity_y_px = options_.disparities_y ? side.disparity_y : nullptr,
          .confidence = side.confidence,
          .unmatched = side.unmatched,
          .check_px = side.check_px,
          .is_result = is_result,
          .search = options_.disparities,
          .search_y = options_.disparities_y.value_or(kAnyDisparity)};
}

void StereoMatcher::match(const Photograph& left, const Photograph& right,
                          const MatchRequest& request, DisparityMaps& maps,
                          MatchReport* report) const {
  require_equal_sizes(left, "left image", right, "right image");
  require_usable(request.prior, left);
  if (!request.prior.empty() && options_.disparities_y) {
    throw UsageError("there is a prior beside disparities-y, expected a search along rows only");
  }
  const bool uses_prior = !request.prior.empty() && request.prior.weight > 0;
  MatchReport own_report;
  MatchReport& times = report != nullptr ? *report : own_report;
  times = {};
  StageClock clock(times);
  clock.begin("prepare");
  const RefinementOptions refinement = options_.resolved_refinement();
  const int check_level = this->check_level(refinement, {left.width(), left.height()});
  MapTask of_left = left_task(left, maps);
  MapTask of_right = right_task(right, maps);
  std::tie(of_left.need, of_right.need) = needs(request, refinement, check_level);
  const auto prepared = prepared_.borrow();
  prepared->parameters = parameters_;
  prepared->of_right = {};
  if (levels_) {
    clock.begin("grey levels");
    settle_levels(left, right, *prepared, times);
    clock.begin("prepare");
  }
  prepare_inputs(of_left, of_right, uses_prior, *prepared);
  if (uses_prior) {
    of_left.input.prior_px = request.prior.left_px;
    of_right.input.prior_px = request.prior.right_px;
    of_left.input.prior_weight = of_right.input.prior_weight = request.prior.weight;
  }
  const bool confidence = wants_confidence(request);
  compute(of_left, "match left", confidence, check_level, *prepared, clock, times);
  compute(of_right, "match right", confidence, check_level, *prepared, clock, times);

  if (options_.raw) {
    if (request.unmatched) {
      mark_unknown(maps.left.view(), execution_, maps.left_unmatched);
      mark_unknown(maps.right.view(), execution_, maps.right_unmatched);
    }
    return;
  }
  const auto work = refinement_works_.borrow();
  const MapToRefine left_map = to_refine(of_left, request.left);
  const MapToRefine right_map = to_refine(of_right, request.right);
  refine_maps(refinement, left_map, &right_map, execution_, *work,
              [&](std::string_view step) { clock.begin(step); });
}

void StereoMatcher::match_several(const Photograph& reference, std::span<const OtherView> others,
                                  const MatchRequest& request, DisparityMaps& maps,
                                  MatchReport* report) const {
  require_different_baselines(others);
  for (std::size_t k = 0; k < others.size(); ++k) {
    require_equal_sizes(reference, "reference image", *others[k].photograph,
                        fmt::format("image {}", k + 1));
  }
  MatchReport own_report;
  MatchReport& times = report != nullptr ? *report : own_report;
  times = {};
  StageClock clock(times);
  clock.begin("prepare");
  const auto geometry =
      candidate_geometry(options_, Side::kLeft, reference.width(), reference.height());
  const auto prepared = prepared_.borrow();
  prepared->parameters = parameters_;
  std::vector<LevelChanges> changes(others.size());
  if (levels_) {
    clock.begin("grey levels");
    changes = settle_levels(reference, others, *prepared, times);
    clock.begin("prepare");
  }
  prepared->images.resize(others.size() + 1);
  prepared->images[0].prepare(reference, prepared->parameters, geometry, {true, false, false},
                              execution_);
  maps = {};
  MapTask side =
      others.front().baseline > 0 ? left_task(reference, maps) : right_task(reference, maps);
  side.need = {.whole = true};
  side.input = {nullptr, prepared->images.data(), {}};
  for (std::size_t k = 0; k < others.size(); ++k) {
    CostImage& image = prepared->images[k + 1];
    const double ratio = others[k].baseline / others.front().baseline;
    image.prepare(*others[k].photograph, prepared->parameters, geometry,
                  {false, true, true, changes[k]}, execution_);
    side.input.partners.push_back({&image, ratio});
  }
  compute(side, "match", wants_confidence(request), 0, *prepared, clock, times);

  if (options_.raw) {
    if (request.unmatched) {
      mark_unknown(side.px->view(), execution_, *side.unmatched);
    }
    return;
  }
  const auto work = refinement_works_.borrow();
  refine_maps(options_.resolved_refinement(), to_refine(side, true), nullptr, execution_, *work,
              [&](std::string_view step) { clock.begin(step); });
}

void StereoMatcher::add_memory_use(MemoryUse& use) const {
  if (levels_) {
    levels_->add_memory_use(use);
  }
  prepared_.for_each_idle([&use](const Prepared& prepared) {
    std::size_t bytes = prepared.pair.grey_8.held_bytes() + prepared.pair.grey_float.held_bytes() +
                        prepared.edges.held_bytes();
    for (const CostImage& image : prepared.images) {
      bytes += image.held_bytes();
    }
    bytes += held_bytes(prepared.coarse_px[0]) + held_bytes(prepared.coarse_px[1]);
    use.add("prepared images", bytes);
    use.add("coarse levels", prepared.search.levels.held_bytes());
  });
  refinement_works_.for_each_idle(
      [&use](const RefinementWork& work) { use.add("refinement", held_bytes_of(work)); });
}

}  // namespace vantage
