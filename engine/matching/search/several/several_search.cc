#include "engine/matching/search/several/several_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/image/left_out.h"
#include "engine/matching/chain/candidate_geometry.h"

namespace vantage {
namespace {

ResolvedMatchOptions without_windows(ResolvedMatchOptions options) {
  options.parameters.window_levels = 0;
  return options;
}

/// Numbers of the images nearest to the first one on its sides: what they do not show, hardly any
/// other image of that side shows.
std::vector<std::size_t> nearest_of_sides(std::span<const SearchedPhotograph> images) {
  std::vector<std::size_t> nearest;
  for (const bool is_ahead : {true, false}) {
    std::optional<std::size_t> best;
    for (std::size_t k = 1; k < images.size(); ++k) {
      if ((images[k].place > 0) == is_ahead &&
          (!best || std::abs(images[k].place) < std::abs(images[*best].place))) {
        best = k;
      }
    }
    if (best) {
      nearest.push_back(*best);
    }
  }
  return nearest;
}

}  // namespace

void SeveralMemory::add_use(MemoryUse& use) const {
  LevelMemory::add_use(use);
  use.add("prepared images",
          held_bytes(partner_maps[0].disparity_px) + held_bytes(partner_maps[1].disparity_px));
}

SearchPlan SeveralSearch::plan(const ResolvedMatchOptions& options, const MatchSize& size) {
  // Levels with lower and upper bounds or gradients, of both images, and mirrored copies.
  std::size_t planes = 4 * 2;
  for (std::size_t k = 1; k < size.baselines.size(); ++k) {
    planes += 4 * static_cast<std::size_t>(sample_phases(size.baselines[k] / size.baselines.front(),
                                                         steps_per_px(options.parameters)));
  }
  SearchPlan plan = full_size_plan(without_windows(options), size, planes);
  if (options.refinement && options.refinement->cross_check) {
    plan.map_bytes += 2 * size.pixels() * sizeof(float);
  }
  return plan;
}

void SeveralSearch::start() {
  job_.parameters.window_levels = 0;
  job_.maps = {};
  const Side side = job_.reference_side;
  job_.tasks = {{.side = side,
                 .image = job_.images.front().photograph,
                 .map = &job_.maps.of(side),
                 .name = "match",
                 .wants_confidence = job_.wants_confidence(),
                 .volumes = job_.request.volumes}};
}

void SeveralSearch::prepare() {
  prepare_map(job_.tasks.front(), 0);
  add_prior(job_.tasks.front().side, input_);
}

/// Prepares the input of the map of image `own`. The task's side: that of the reference, or the
/// other one, whose partners lie in the other direction.
void SeveralSearch::prepare_map(const MapTask& task, std::size_t own) {
  const auto geometry =
      candidate_geometry(job_.options, Side::kLeft, task.image->width(), task.image->height());
  const double direction = task.side == job_.reference_side ? 1 : -1;
  own_.images.resize(job_.images.size());
  input_ = {nullptr, &own_.images[own], {}};
  for (std::size_t k = 0; k < job_.images.size(); ++k) {
    const SearchedPhotograph& image = job_.images[k];
    const bool is_own = k == own;
    const double ratio = (image.place - job_.images[own].place) * direction;
    const bool is_ahead = (task.side == Side::kLeft) == (ratio > 0);
    own_.images[k].prepare(*image.photograph, job_.parameters, geometry,
                           {.as_reference = is_own,
                            .as_partner_of_left = !is_own && is_ahead,
                            .as_partner_of_right = !is_own && !is_ahead,
                            .phases = is_own ? 1 : sample_phases(ratio, geometry.steps_per_px)},
                           job_.execution);
    if (!is_own) {
      input_.partners.push_back({&own_.images[k], ratio});
    }
  }
}

/// The maps that the reference's is checked against.
std::vector<PartnerMap> SeveralSearch::search_partners() {
  const Side side = job_.reference_side;
  std::vector<PartnerMap> partners;
  for (const std::size_t k : nearest_of_sides(job_.images)) {
    MatchedMap& map = own_.partner_maps[partners.size()];
    // As the other map of a pair with the reference.
    MapTask check{.side = job_.images[k].place > 0 ? other_side(side) : side,
                  .image = job_.images[k].photograph,
                  .map = &map,
                  .name = "match check",
                  .need = {.whole = true}};
    start_stage("prepare");
    prepare_map(check, k);
    start_stage(check.name);
    search_levels(check, input_);
    erase_left_out(check.image->left_out, map);
    partners.push_back({std::as_const(map.disparity_px).view(), job_.images[k].place});
  }
  return partners;
}

void SeveralSearch::refine(RefinementWork& work) {
  if (!job_.options.refinement) {
    mark_all_unknown();
    return;
  }
  std::vector<PartnerMap> partners;
  if (job_.is_checked()) {
    partners = search_partners();
  }
  MapToRefine map = to_refine(job_.tasks.front());
  map.partners = partners;
  refine_maps(*job_.options.refinement, map, nullptr, job_.execution, work,
              [this](std::string_view step) { start_stage(step); });
}

}  // namespace vantage
