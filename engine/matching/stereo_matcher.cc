#include "engine/matching/stereo_matcher.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "engine/error.h"
#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/match_memory.h"
#include "engine/matching/search/coarse_to_fine/level_search.h"
#include "engine/matching/selection/symmetric_energies.h"
#include "engine/matching/stage_clock.h"
#include "engine/matching/stereo_matcher_parts.h"
#include "engine/matching/windows/window_level.h"
#include "engine/out_of_memory.h"

namespace vantage {
namespace {

ResolvedMatchOptions checked(const MatchOptions& options) {
  options.validate();
  if (options.disparities_auto || options.disparities_y_auto) {
    throw UsageError("disparities is auto, expected the range that the images suggest");
  }
  return options.in_force();
}

}  // namespace

StereoMatcher::StereoMatcher(const MatchOptions& options, Execution& execution)
    : in_force_(checked(options)),
      execution_(execution),
      parts_(std::make_unique<Parts>(in_force_, execution)) {
  if (uses_pair_exposure(in_force_.parameters)) {
    parts_->exposure = std::make_unique<PairExposureEstimator>(in_force_.disparities, execution_);
  }
}

StereoMatcher::~StereoMatcher() = default;

LevelPlan StereoMatcher::level_plan_of(scheduler::Extent image) const {
  return level_plan(in_force_.parameters, image,
                    candidate_count(in_force_.disparities, in_force_.parameters));
}

int StereoMatcher::check_level(scheduler::Extent image) const {
  if (!in_force_.refinement) {
    return 0;
  }
  return std::min(in_force_.refinement->cross_check_level, level_plan_of(image).coarsest());
}

bool StereoMatcher::wants_confidence(const MatchRequest& request) const {
  return request.confidence || (in_force_.refinement && uses_confidence(*in_force_.refinement));
}

/// Estimates grey level parameters from a pair.
void StereoMatcher::estimate_exposure(const Photograph& left, const Photograph& right,
                                      Prepared& prepared, MatchReport& report) const {
  // Throws for the whole images: the bands' own message would name the size of the bands.
  candidate_geometry(in_force_, Side::kLeft, left.width(), left.height());
  const PairExposure exposure = parts_->exposure->estimate(left, right, in_force_.parameters.colour,
                                                           in_force_.parameters.match_exposure);
  prepared.of_right = exposure.of_right;
  if (in_force_.parameters.estimate_sigma_measurement && exposure.sigma_measurement) {
    prepared.parameters.sigma_measurement = *exposure.sigma_measurement;
  }
  report.exposure = exposure;
}

/// Prepares the inputs of both maps' chains.
void StereoMatcher::prepare_inputs(MapTask& left, MapTask& right, bool uses_prior,
                                   Prepared& prepared,
                                   std::span<const VolumeRequest> volumes) const {
  const bool needs_left = left.need.any();
  const bool needs_right = right.need.any();
  const auto geometry =
      candidate_geometry(in_force_, Side::kLeft, left.image->width(), left.image->height());
  const bool uses_pair =
      uses_column_ssd(in_force_.parameters) && !in_force_.disparities_y && !uses_prior;
  const bool needs_costs = std::ranges::any_of(
      volumes, [](const VolumeRequest& volume) { return volume.kind == VolumeKind::kCosts; });
  // Windows read plain rows, with margins on both sides.
  const bool has_windows = prepared.parameters.window_levels > 0;
  const auto margins = has_windows ? window_margins(geometry) : geometry;
  if (!uses_pair || needs_costs) {
    prepared.images.resize(2);
    CostImage& left_image = prepared.images[0];
    CostImage& right_image = prepared.images[1];
    const int phases = sample_phases(1, geometry.steps_per_px);
    left_image.prepare(*left.image, prepared.parameters, margins,
                       {.as_reference = needs_left,
                        .as_partner_of_left = false,
                        .as_partner_of_right = needs_right || has_windows,
                        .phases = phases},
                       execution_);
    right_image.prepare(*right.image, prepared.parameters, margins,
                        {.as_reference = needs_right,
                         .as_partner_of_left = needs_left,
                         .as_partner_of_right = has_windows,
                         .intensity_changes = prepared.of_right,
                         .phases = phases},
                        execution_);
    left.input = {nullptr, &left_image, {CostPartner{&right_image}}};
    right.input = {nullptr, &right_image, {CostPartner{&left_image}}};
  }
  if (uses_pair) {
    prepare_pair(*left.image, *right.image, geometry,
                 in_force_.parameters.window_px * in_force_.parameters.window_px,
                 {needs_left, needs_right}, execution_, prepared.pair);
    left.input.pair = right.input.pair = &prepared.pair;
  }
}

bool StereoMatcher::uses_check_maps(scheduler::Extent image) const {
  return level_plan_of(image).has_check_map && !in_force_.disparities_y &&
         in_force_.refinement->edge_snapping_px == 0;
}

/// What is computed of each image's map: the map if it is requested or needed to check the other
/// one; what the other one is checked against.
std::pair<StereoMatcher::MapNeed, StereoMatcher::MapNeed> StereoMatcher::needs(
    const MatchRequest& request, scheduler::Extent image) const {
  const bool is_checked = in_force_.refinement && in_force_.refinement->cross_check;
  const bool has_level = is_checked && check_level(image) > 0;
  const bool has_check_maps = is_checked && !has_level && uses_check_maps(image);
  const auto need = [&](bool is_wanted, bool is_other_wanted) -> MapNeed {
    return {.whole = is_wanted || (is_checked && !has_level),
            .coarse = has_level && is_other_wanted,
            .check = has_check_maps && is_other_wanted,
            .check_is_only = has_check_maps && !is_wanted};
  };
  return {need(request.left, request.right), need(request.right, request.left)};
}

/// Chooses the tiles of both maps that are searched.
void StereoMatcher::choose_tiles(MapTask& left, MapTask& right, bool wants_confidence,
                                 PreviousMaps& previous, Prepared& prepared,
                                 MatchReport& report) const {
  std::uint32_t needed = wants_confidence ? 1 : 0;
  for (MapTask* const task : {&left, &right}) {
    prepared.halves[index_of(task->side)].prepare(*task->image, 1, execution_);
    for (const bool is_needed :
         {task->need.whole, task->need.coarse, task->need.check, task->need.check_is_only}) {
      needed = 2 * needed + (is_needed ? 1 : 0);
    }
  }
  if (previous.choose(prepared.halves[0].reduced(1), prepared.halves[1].reduced(1),
                      {{left.image->width(), left.image->height()}, needed})) {
    left.previous = right.previous = &previous;
  } else {
    report.searched_share = 1;
  }
}

/// Resizes the images of the task's map and computes what is needed of it.
void StereoMatcher::compute(MapTask& task, std::string_view name, bool wants_confidence,
                            int check_level, Prepared& prepared, StageClock& clock,
                            MatchReport& report, std::span<const VolumeRequest> volumes) const {
  const auto resize = [&](Image<float>& image, bool is_wanted) {
    image.resize(is_wanted ? task.image->width() : 0, is_wanted ? task.image->height() : 0);
  };
  PreviousMaps::OfSide* const kept =
      task.previous != nullptr ? &task.previous->of(task.side) : nullptr;
  MatchedMap& map = kept != nullptr ? kept->winners : *task.map;
  resize(map.disparity_px, task.need.whole);
  resize(map.confidence, task.need.whole && wants_confidence);
  resize(map.disparity_y_px, task.need.whole && in_force_.disparities_y);
  DisparityMap& check_px =
      kept != nullptr ? kept->check_px : prepared.check_px[index_of(task.side)];
  resize(check_px, task.need.check && !task.need.check_is_only);
  if (!task.need.any()) {
    return;
  }
  clock.start(name);
  task.input.edges = prepared.edges.prepare(*task.image, in_force_.parameters, execution_);
  CoarseMap coarse;
  if (task.need.coarse) {
    coarse = {.level = check_level,
              .winners = kept != nullptr ? &kept->coarse_winners
                                         : &prepared.coarse_winners[index_of(task.side)],
              .is_only = !task.need.whole};
  }
  CheckMap check;
  if (task.need.check) {
    check = {.disparity_px = (task.need.check_is_only ? map.disparity_px : check_px).view(),
             .is_only = task.need.check_is_only};
    task.check_px = check.disparity_px;
  }
  // Without a map of its own only the size is used.
  const ImageView<float> size_alone(nullptr, task.image->width(), task.image->height(), 1, 0);
  const TileMask* const tiles =
      kept != nullptr ? task.previous->searched_tiles(task.side) : nullptr;
  SearchedParts parts;
  if (tiles != nullptr) {
    parts = searched_parts(*tiles, kept->levels.plan(), prepared.parameters);
  }
  LevelSearch(in_force_, prepared.parameters, execution_,
              kept != nullptr ? kept->levels : prepared.levels, report)
      .compute(task.side, task.input,
               {.outputs = {.disparity_px = task.need.whole ? map.disparity_px.view() : size_alone,
                            .confidence = map.confidence.view(),
                            .disparity_y_px = map.disparity_y_px.view()},
                .coarse = coarse,
                .check = check,
                .parts = tiles != nullptr ? &parts : nullptr},
               task.need.whole ? volumes : std::span<const VolumeRequest>());
  if (kept != nullptr) {
    report.searched_share = std::max(report.searched_share.value_or(0), kept->searched.share());
    if (task.need.whole && !task.need.check_is_only) {
      copy_winners(kept->winners, execution_, *task.map);
    }
  }
  if (coarse.winners != nullptr) {
    const auto geometry =
        candidate_geometry(in_force_, task.side, task.image->width(), task.image->height());
    task.coarse = {.winners = std::as_const(*coarse.winners).view(),
                   .level = check_level,
                   .disparity_min = geometry.disparity_min,
                   .steps_per_px = geometry.steps_per_px};
  }
}

/// Computes both maps from one solution (§3.17): the right image's energies are stored, then the
/// left image's chain selects.
void StereoMatcher::compute_symmetric(MapTask& left, MapTask& right, bool wants_confidence,
                                      Prepared& prepared, StageClock& clock, MatchReport& report,
                                      std::span<const VolumeRequest> volumes) const {
  const int width = left.image->width();
  const int height = left.image->height();
  try {
    prepared.right_energies.resize(
        {width, height}, candidate_geometry(in_force_, Side::kLeft, width, height).lanes(),
        sizeof(kernels::StepEnergy));
  } catch (const std::bad_alloc&) {
    const int candidates = candidate_count(in_force_.disparities, in_force_.parameters);
    throw OutOfMemory(fmt::format(
        "symmetric selection, which keeps {} MiB of energies ({}x{} pixels, {} candidates)",
        symmetric_energy_bytes(in_force_.parameters, {width, height}, candidates) >> 20, width,
        height, candidates));
  }
  SymmetricPlace place{.right = &prepared.right_energies};
  left.input.symmetric = right.input.symmetric = &place;
  compute(right, "match right", wants_confidence, 0, prepared, clock, report, volumes);
  place.is_stored = true;
  place.right_outputs = {.disparity_px = right.map->disparity_px.view(),
                         .confidence = right.map->confidence.view()};
  compute(left, "match left", wants_confidence, 0, prepared, clock, report, volumes);
}

MapToRefine StereoMatcher::to_refine(const MapTask& task, bool is_result) const {
  return {.side = task.side,
          .image = task.image,
          .map = task.map,
          .coarse = task.coarse,
          .check_px = task.check_px,
          .is_result = is_result,
          .search = in_force_.disparities,
          .search_y = in_force_.disparities_y.value_or(kAnyDisparity),
          .kept = task.previous != nullptr ? &task.previous->of(task.side).refinement : nullptr};
}

/// Throws Error where a match cannot succeed. keeps_costs: for the pair after it.
void StereoMatcher::require_memory(const Photograph& image, bool keeps_costs,
                                   std::span<const double> baselines) const {
  const std::string obstacle = memory_obstacle(
      in_force_,
      {.image = {image.width(), image.height()},
       .channels = image.channels(),
       .baselines = baselines,
       .level_bytes = keeps_costs
                          ? kWithoutBands
                          : execution_.options().level_memory_bytes.value_or(kDefaultLevelBytes)},
      execution_.machine().memory_bytes);
  if (!obstacle.empty()) {
    throw Error(obstacle);
  }
}

/// Throws UsageError where maps cannot keep anything from the pair before.
void StereoMatcher::require_reuse(const MatchRequest& request, bool uses_prior) const {
  const std::string_view obstacle = uses_prior                 ? "a prior"
                                    : !request.volumes.empty() ? "volumes"
                                                               : reuse_obstacle(in_force_);
  if (!obstacle.empty()) {
    throw UsageError(
        fmt::format("there are maps of the pair before with {}, expected none", obstacle));
  }
}

void StereoMatcher::match(const Photograph& left, const Photograph& right,
                          const MatchRequest& request, DisparityMaps& maps,
                          MatchReport* report) const {
  require_equal_sizes(left, "left image", right, "right image");
  require_usable(request.prior, left);
  if (!request.prior.empty() && in_force_.disparities_y) {
    throw UsageError("there is a prior beside disparities-y, expected a search along rows only");
  }
  const bool uses_prior = !request.prior.empty() && request.prior.weight > 0;
  if (request.previous != nullptr) {
    require_reuse(request, uses_prior);
  }
  MatchReport own_report;
  MatchReport& times = report != nullptr ? *report : own_report;
  const bool is_resumed =
      request.previous == nullptr && request.deferred != nullptr && request.deferred->is_pending;
  if (!is_resumed) {
    times = {};
  }
  StageClock clock(times);
  clock.start("prepare");
  require_memory(left, request.previous != nullptr);
  if (search_reductions(in_force_, {left.width(), left.height()}) > 0) {
    if (uses_prior) {
      throw UsageError("there is a prior, expected none with a reduced search-size");
    }
    if (!request.volumes.empty()) {
      throw UsageError(
          "there is no volume with a reduced search-size (preset realtime), which searches a few "
          "candidates around those of smaller images; expected search-size full");
    }
    parts_->reduced.match(
        left, right,
        {.left = request.left, .right = request.right, .confidence = request.confidence},
        request.previous, request.deferred, maps, clock, times);
    return;
  }
  if (is_resumed) {
    *request.deferred = {};
  }
  const int check_level = this->check_level({left.width(), left.height()});
  MapTask of_left{.side = Side::kLeft, .image = &left, .map = &maps.left};
  MapTask of_right{.side = Side::kRight, .image = &right, .map = &maps.right};
  std::tie(of_left.need, of_right.need) = needs(request, {left.width(), left.height()});
  const bool is_symmetric = in_force_.parameters.selection == Selection::kSymmetric;
  if (is_symmetric) {
    of_left.need.whole = of_right.need.whole = true;
  }
  const auto prepared = parts_->prepared.borrow();
  prepared->parameters = in_force_.parameters;
  prepared->of_right = {};
  if (parts_->exposure) {
    clock.start("grey levels");
    estimate_exposure(left, right, *prepared, times);
    clock.start("prepare");
  }
  const bool confidence = wants_confidence(request);
  if (request.previous != nullptr) {
    clock.start("changes");
    choose_tiles(of_left, of_right, confidence, *request.previous, *prepared, times);
    if (of_left.previous == nullptr && request.deferred != nullptr) {
      request.deferred->is_pending = true;
      return;
    }
    clock.start("prepare");
  }
  prepare_inputs(of_left, of_right, uses_prior, *prepared, request.volumes);
  if (uses_prior) {
    of_left.input.prior_px = request.prior.left_px;
    of_right.input.prior_px = request.prior.right_px;
    of_left.input.prior_weight = of_right.input.prior_weight = request.prior.weight;
  }
  if (of_left.need.any() && of_right.need.any() && of_left.previous == nullptr && !is_symmetric &&
      !in_force_.disparities_y &&
      shares_costs(prepared->parameters, of_left.input, {left.width(), left.height()},
                   candidate_count(in_force_.disparities, prepared->parameters))) {
    of_left.input.sharing = CostSharing::kStores;
    of_right.input.sharing = CostSharing::kUses;
  }
  if (is_symmetric) {
    compute_symmetric(of_left, of_right, confidence, *prepared, clock, times, request.volumes);
  } else {
    compute(of_left, "match left", confidence, check_level, *prepared, clock, times,
            request.volumes);
    compute(of_right, "match right", confidence, check_level, *prepared, clock, times,
            request.volumes);
  }
  if (prepared->levels.plan().bands.levels > 0) {
    // Of very large images: refinement needs the memory.
    prepared->levels = {};
    prepared->images.clear();
  }

  if (!in_force_.refinement) {
    if (request.unmatched) {
      mark_unknown(maps.left.disparity_px.view(), execution_, maps.left.unmatched);
      mark_unknown(maps.right.disparity_px.view(), execution_, maps.right.unmatched);
    }
    return;
  }
  const auto work = parts_->refinement_works.borrow();
  const MapToRefine left_map = to_refine(of_left, request.left);
  const MapToRefine right_map = to_refine(of_right, request.right);
  refine_maps(*in_force_.refinement, left_map, &right_map, execution_, *work,
              [&](std::string_view step) { clock.start(step); });
}

void StereoMatcher::add_memory_use(MemoryUse& use) const {
  parts_->reduced.add_memory_use(use);
  if (parts_->exposure) {
    parts_->exposure->add_memory_use(use);
  }
  parts_->prepared.for_each_idle([&use](const Prepared& prepared) {
    std::size_t bytes = prepared.pair.grey_8.held_bytes() + prepared.pair.grey_float.held_bytes() +
                        prepared.edges.held_bytes();
    for (const CostImage& image : prepared.images) {
      bytes += image.held_bytes();
    }
    bytes += held_bytes(prepared.coarse_winners[0]) + held_bytes(prepared.coarse_winners[1]) +
             held_bytes(prepared.check_px[0]) + held_bytes(prepared.check_px[1]);
    for (const MatchedMap& map : prepared.partner_maps) {
      bytes += held_bytes(map.disparity_px);
    }
    use.add("prepared images", bytes);
    use.add("coarse levels", prepared.levels.held_bytes());
    use.add("prepared images", prepared.halves[0].held_bytes() + prepared.halves[1].held_bytes());
    use.add("symmetric energies", prepared.right_energies.held_bytes());
  });
  parts_->refinement_works.for_each_idle(
      [&use](const RefinementWork& work) { use.add("refinement", held_bytes(work)); });
}

}  // namespace vantage
