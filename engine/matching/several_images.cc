#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/stage_clock.h"
#include "engine/matching/stereo_matcher_parts.h"

// StereoMatcher with several other images.

namespace vantage {
namespace {

std::vector<PlacedImage> placed(const Photograph& reference, std::span<const OtherView> others) {
  std::vector<PlacedImage> images{{&reference}};
  for (const OtherView& other : others) {
    images.push_back({other.photograph, other.baseline / others.front().baseline});
  }
  return images;
}

/// Numbers of the images nearest to the first one on its sides: what they do not show, hardly any
/// other image of that side shows.
std::vector<std::size_t> nearest_of_sides(std::span<const PlacedImage> images) {
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

/// Estimates each other image against the reference; σ is that of the noisiest.
std::vector<IntensityChanges> StereoMatcher::estimate_exposure(const Photograph& reference,
                                                               std::span<const OtherView> others,
                                                               Prepared& prepared,
                                                               MatchReport& report) const {
  std::vector<IntensityChanges> changes;
  std::optional<double> sigma;
  for (const OtherView& other : others) {
    // In units of x_reference − x_other.
    const double ratio = other.baseline / std::abs(others.front().baseline);
    const auto [min, max] =
        std::minmax({in_force_.disparities.min * ratio, in_force_.disparities.max * ratio});
    const DisparityRange range{static_cast<int>(std::floor(min)), static_cast<int>(std::ceil(max))};
    const PairExposure exposure =
        PairExposureEstimator(range, execution_)
            .estimate(reference, *other.photograph, in_force_.parameters.colour,
                      in_force_.parameters.match_exposure);
    changes.push_back(exposure.of_right);
    if (exposure.sigma_measurement) {
      sigma = std::max(sigma.value_or(0), *exposure.sigma_measurement);
    }
    if (!report.exposure) {
      report.exposure = exposure;
    }
  }
  if (in_force_.parameters.estimate_sigma_measurement && sigma) {
    prepared.parameters.sigma_measurement = *sigma;
  }
  return changes;
}

/// Throws where images cannot be matched at once.
void StereoMatcher::require_several(const Photograph& reference,
                                    std::span<const OtherView> others) const {
  if (in_force_.parameters.selection == Selection::kSymmetric) {
    throw UsageError(
        "selection is symmetric, expected winner or scanline with several baselines: a symmetric "
        "solution is of two images");
  }
  require_different_baselines(others);
  for (std::size_t k = 0; k < others.size(); ++k) {
    require_equal_sizes(reference, "reference image", *others[k].photograph,
                        fmt::format("image {}", k + 1));
  }
}

/// Prepares the input of the chain of one of the images. The task's side: that of the reference, or
/// the other one, whose partners lie in the other direction.
void StereoMatcher::prepare_several(MapTask& task, std::size_t own,
                                    std::span<const PlacedImage> images, Side reference_side,
                                    Prepared& prepared) const {
  const auto geometry =
      candidate_geometry(in_force_, Side::kLeft, task.image->width(), task.image->height());
  const double direction = task.side == reference_side ? 1 : -1;
  prepared.images.resize(images.size());
  task.input = {nullptr, &prepared.images[own], {}};
  for (std::size_t k = 0; k < images.size(); ++k) {
    const double ratio = (images[k].place - images[own].place) * direction;
    prepared.images[k].prepare(
        *images[k].photograph, prepared.parameters, geometry,
        {.as_reference = k == own,
         .as_partner_of_left = k != own && (task.side == Side::kLeft) == (ratio > 0),
         .as_partner_of_right = k != own && (task.side == Side::kLeft) != (ratio > 0),
         .intensity_changes = images[k].changes,
         .phases = k == own ? 1 : sample_phases(ratio, geometry.steps_per_px)},
        execution_);
    if (k != own) {
      task.input.partners.push_back({&prepared.images[k], ratio});
    }
  }
}

scheduler::ChainPlan StereoMatcher::plan_several(const Photograph& reference,
                                                 std::span<const OtherView> others) const {
  require_several(reference, others);
  const auto prepared = parts_->prepared.borrow();
  prepared->parameters = in_force_.parameters;
  prepared->parameters.window_levels = 0;
  MatchedMap map;  // never read
  MapTask task{.side = Side::kLeft, .image = &reference, .map = &map};
  prepare_several(task, 0, placed(reference, others), task.side, *prepared);
  return plans_of(task, *prepared, {&execution_.options(), 1}).front();
}

void StereoMatcher::match_several(const Photograph& reference, std::span<const OtherView> others,
                                  const MatchRequest& request, DisparityMaps& maps,
                                  MatchReport* report) const {
  require_several(reference, others);
  require_usable(request.prior, reference);
  MatchReport own_report;
  MatchReport& times = report != nullptr ? *report : own_report;
  times = {};
  StageClock clock(times);
  clock.start("prepare");
  std::vector<double> baselines;
  for (const OtherView& other : others) {
    baselines.push_back(other.baseline);
  }
  require_memory(reference, false, baselines);
  const auto prepared = parts_->prepared.borrow();
  prepared->parameters = in_force_.parameters;
  prepared->parameters.window_levels = 0;  // windows compare two images
  std::vector<PlacedImage> images = placed(reference, others);
  if (parts_->exposure) {
    clock.start("grey levels");
    const auto changes = estimate_exposure(reference, others, *prepared, times);
    for (std::size_t k = 0; k < others.size(); ++k) {
      images[k + 1].changes = changes[k];
    }
    clock.start("prepare");
  }
  maps = {};
  const Side side = others.front().baseline > 0 ? Side::kLeft : Side::kRight;
  MapTask task{.side = side, .image = &reference, .map = &maps.of(side)};
  task.need = {.whole = true};
  prepare_several(task, 0, images, side, *prepared);
  if (!request.prior.empty() && request.prior.weight > 0) {
    task.input.prior_px = side == Side::kLeft ? request.prior.left_px : request.prior.right_px;
    task.input.prior_weight = request.prior.weight;
  }
  compute(task, "match", wants_confidence(request), 0, *prepared, clock, times, request.volumes);

  if (!in_force_.refinement) {
    if (request.unmatched) {
      mark_unknown(task.map->disparity_px.view(), execution_, task.map->unmatched);
    }
    return;
  }
  std::vector<PartnerMap> partners;
  if (in_force_.refinement->cross_check) {
    for (const std::size_t k : nearest_of_sides(images)) {
      MatchedMap& map = prepared->partner_maps[partners.size()];
      // As the other map of a pair with the reference.
      MapTask check{.side = images[k].place > 0 ? other_side(side) : side,
                    .image = images[k].photograph,
                    .map = &map,
                    .need = {.whole = true}};
      clock.start("prepare");
      prepare_several(check, k, images, side, *prepared);
      compute(check, "match check", false, 0, *prepared, clock, times, {});
      partners.push_back({std::as_const(map.disparity_px).view(), images[k].place});
    }
  }
  MapToRefine map = to_refine(task, true);
  map.partners = partners;
  const auto work = parts_->refinement_works.borrow();
  refine_maps(*in_force_.refinement, map, nullptr, execution_, *work,
              [&](std::string_view step) { clock.start(step); });
}

}  // namespace vantage
