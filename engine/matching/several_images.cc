#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "engine/error.h"
#include "engine/matching/candidate_geometry.h"
#include "engine/matching/stage_clock.h"
#include "engine/matching/stereo_matcher_parts.h"

// StereoMatcher with several other images.

namespace vantage {

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

/// Prepares the input of the reference's chain.
void StereoMatcher::prepare_several(MapTask& task, std::span<const OtherView> others,
                                    std::span<const IntensityChanges> changes,
                                    Prepared& prepared) const {
  const Photograph& reference = *task.image;
  const auto geometry =
      candidate_geometry(in_force_, Side::kLeft, reference.width(), reference.height());
  prepared.images.resize(others.size() + 1);
  prepared.images[0].prepare(reference, prepared.parameters, geometry, {true, false, false},
                             execution_);
  task.input = {nullptr, prepared.images.data(), {}};
  for (std::size_t k = 0; k < others.size(); ++k) {
    CostImage& image = prepared.images[k + 1];
    const double ratio = others[k].baseline / others.front().baseline;
    image.prepare(*others[k].photograph, prepared.parameters, geometry,
                  {.as_reference = false,
                   .as_partner_of_left = (task.side == Side::kLeft) == (ratio > 0),
                   .as_partner_of_right = (task.side == Side::kLeft) != (ratio > 0),
                   .intensity_changes = changes[k],
                   .phases = sample_phases(ratio, geometry.steps_per_px)},
                  execution_);
    task.input.partners.push_back({&image, ratio});
  }
}

scheduler::ChainPlan StereoMatcher::plan_several(const Photograph& reference,
                                                 std::span<const OtherView> others) const {
  require_several(reference, others);
  const auto prepared = parts_->prepared.borrow();
  prepared->parameters = in_force_.parameters;
  prepared->parameters.window_levels = 0;
  MatchedMap map;  // never read
  map.disparity_px.resize(reference.width(), reference.height());
  MapTask task{.side = Side::kLeft, .image = &reference, .map = &map};
  prepare_several(task, others, std::vector<IntensityChanges>(others.size()), *prepared);
  const auto geometry =
      candidate_geometry(in_force_, Side::kLeft, reference.width(), reference.height());
  return plans_of(prepared->parameters, task, geometry, {&execution_.options(), 1}).front();
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
  const auto prepared = parts_->prepared.borrow();
  prepared->parameters = in_force_.parameters;
  prepared->parameters.window_levels = 0;  // windows compare two images
  std::vector<IntensityChanges> changes(others.size());
  if (parts_->exposure) {
    clock.start("grey levels");
    changes = estimate_exposure(reference, others, *prepared, times);
    clock.start("prepare");
  }
  maps = {};
  const Side side = others.front().baseline > 0 ? Side::kLeft : Side::kRight;
  MapTask task{.side = side, .image = &reference, .map = &maps.of(side)};
  task.need = {.whole = true};
  prepare_several(task, others, changes, *prepared);
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
  const auto work = parts_->refinement_works.borrow();
  refine_maps(*in_force_.refinement, to_refine(task, true), nullptr, execution_, *work,
              [&](std::string_view step) { clock.start(step); });
}

}  // namespace vantage
