#include "engine/matching/unrectified/unrectified_matcher.h"

#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/chain/candidate_geometry.h"
#include "engine/matching/costs/cost_image.h"
#include "engine/matching/match_inputs.h"
#include "engine/matching/match_memory.h"
#include "engine/matching/search/coarse_to_fine/level_search.h"
#include "engine/matching/stage_clock.h"
#include "engine/refinement/refine_maps.h"

namespace vantage {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Without what works on two images whose rows correspond.
ResolvedMatchOptions along_lines(const MatchOptions& options) {
  options.validate();
  if (options.disparities_auto) {
    throw UsageError("disparities is auto, expected the range that the images suggest");
  }
  if (options.disparities_y) {
    throw UsageError("disparities-y is set, expected none along epipolar lines");
  }
  ResolvedMatchOptions resolved = options.in_force();
  if (resolved.parameters.selection == Selection::kSymmetric) {
    throw UsageError(
        "selection is symmetric, expected winner or scanline along epipolar lines: pixels of both "
        "photographs lie on different ones");
  }
  resolved.parameters.window_levels = 0;
  return resolved;
}

}  // namespace

void UnrectifiedMatcher::validate(MatchOptions options) {
  options.disparities_auto = false;
  (void)along_lines(options);
}

UnrectifiedMatcher::UnrectifiedMatcher(const MatchOptions& options, const Rectifier& rectifier,
                                       std::shared_ptr<const EpipolarGrids> grids,
                                       Execution& execution)
    : in_force_(along_lines(options)),
      rectifier_(rectifier),
      execution_(execution),
      grids_(std::move(grids)) {
  if (uses_pair_exposure(in_force_.parameters)) {
    exposure_ = std::make_unique<PairExposureEstimator>(in_force_.disparities, execution_);
  }
}

void UnrectifiedMatcher::search(Side side, const std::array<const Photograph*, 2>& photographs,
                                const MethodParameters& parameters,
                                const IntensityChanges& of_right, bool wants_confidence,
                                MatchedMap& map, MatchReport& report) const {
  const Photograph& reference = *photographs[index_of(side)];
  const Photograph& other = *photographs[index_of(other_side(side))];
  const EpipolarGrid& grid = (*grids_)[index_of(side)];
  const auto geometry =
      candidate_geometry(in_force_, Side::kLeft, reference.width(), reference.height());
  const auto changes_of = [&](Side image) {
    return image == Side::kRight ? of_right : IntensityChanges();
  };
  CostImage of_reference;
  of_reference.prepare(reference, parameters, geometry,
                       {.as_reference = true,
                        .as_partner_of_left = false,
                        .as_partner_of_right = false,
                        .intensity_changes = changes_of(side)},
                       execution_);
  constexpr int kPhases = EpipolarGrid::kPhases;
  std::vector<CostImage> of_other(kPhases);
  for (int down = 0; down < kPhases; ++down) {
    std::array<Photograph, kPhases> at_phases;
    for (int along = 0; along < kPhases; ++along) {
      grid.sample(other, along, down, at_phases[static_cast<std::size_t>(along)], execution_);
    }
    of_other[static_cast<std::size_t>(down)].prepare_samples(
        at_phases, parameters, geometry,
        {.as_reference = false,
         .as_partner_of_left = side == Side::kLeft,
         .as_partner_of_right = side == Side::kRight,
         .intensity_changes = changes_of(other_side(side))},
        execution_);
  }
  map.disparity_px.resize(reference.width(), reference.height());
  map.confidence.resize(wants_confidence ? reference.width() : 0,
                        wants_confidence ? reference.height() : 0);
  map.disparity_y_px.resize(0, 0);
  EdgeWeightLevels edges;
  ChainInput input{nullptr, &of_reference, {}};
  input.partners.push_back({.image = of_other.data(), .epipolar = &grid});
  input.edges = edges.prepare(reference, parameters, execution_);
  CoarseLevels levels;
  LevelSearch(in_force_, parameters, execution_, levels, report)
      .compute(side, input,
               {.outputs = {.disparity_px = map.disparity_px.view(),
                            .confidence = map.confidence.view()}});
}

void UnrectifiedMatcher::check(Side side, const DisparityMap& other_px, double tolerance_px,
                               DisparityMap& map_px) const {
  const EpipolarGrid& grid = (*grids_)[index_of(side)];
  const int direction = direction_of(side);
  execution_.for_each_band(map_px.height(), [&](int first, int end) {
    for (int y = first; y < end; ++y) {
      for (int x = 0; x < map_px.width(); ++x) {
        float& own_px = map_px.at(x, y);
        const EpipolarGrid::Place& place = grid.place(x, y);
        const double shift = static_cast<double>(own_px) * EpipolarGrid::kPhases;
        const Eigen::Vector2d partner =
            grid.position_of(place.line, place.sample + direction * shift);
        const double column = std::floor(partner.x() + 0.5);
        const double row = std::floor(partner.y() + 0.5);
        const bool is_inside = place.has_line && column >= 0 && column < other_px.width() &&
                               row >= 0 && row < other_px.height();
        if (!is_inside || !(std::abs(other_px.at(static_cast<int>(column), static_cast<int>(row)) -
                                     own_px) < tolerance_px)) {
          own_px = kNaN;
        }
      }
    }
  });
}

void UnrectifiedMatcher::match(const Photograph& left, const Photograph& right,
                               const UnrectifiedRequest& request, DisparityMaps& maps,
                               MatchReport* report) const {
  require_equal_sizes(left, "left image", right, "right image");
  const std::string obstacle = memory_obstacle(
      in_force_,
      {.image = {left.width(), left.height()},
       .channels = left.channels(),
       .along_lines = true,
       .level_bytes = execution_.options().level_memory_bytes.value_or(kDefaultLevelBytes)},
      execution_.machine().memory_bytes);
  if (!obstacle.empty()) {
    throw Error(obstacle);
  }
  MatchReport own_report;
  MatchReport& times = report != nullptr ? *report : own_report;
  times = {};
  StageClock clock(times);
  MethodParameters parameters = in_force_.parameters;
  IntensityChanges of_right;
  if (exposure_) {
    clock.start("grey levels");
    std::array<Photograph, 2> rectified;
    rectifier_.apply(left, Side::kLeft, rectified[0], execution_);
    rectifier_.apply(right, Side::kRight, rectified[1], execution_);
    const PairExposure exposure = exposure_->estimate(rectified[0], rectified[1], parameters.colour,
                                                      parameters.match_exposure);
    of_right = exposure.of_right;
    if (parameters.estimate_sigma_measurement && exposure.sigma_measurement) {
      parameters.sigma_measurement = *exposure.sigma_measurement;
    }
    times.exposure = exposure;
  }
  const std::array<const Photograph*, 2> photographs = {&left, &right};
  const bool is_checked = in_force_.refinement && in_force_.refinement->cross_check;
  const bool wants_confidence =
      request.confidence || (in_force_.refinement && uses_confidence(*in_force_.refinement));
  const auto is_wanted = [&](Side side) {
    return side == Side::kLeft ? request.left : request.right;
  };
  for (const Side side : {Side::kLeft, Side::kRight}) {
    if (is_wanted(side) || is_checked) {
      clock.start(side == Side::kLeft ? "match left" : "match right");
      search(side, photographs, parameters, of_right, wants_confidence, maps.of(side), times);
    }
  }
  if (is_checked) {
    clock.start("cross-check");
    const DisparityMap left_px = maps.left.disparity_px.copy();
    for (const Side side : {Side::kLeft, Side::kRight}) {
      if (is_wanted(side)) {
        check(side, side == Side::kLeft ? maps.right.disparity_px : left_px,
              in_force_.refinement->cross_check_px, maps.of(side).disparity_px);
      }
    }
  }
  RefinementWork work;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    if (!is_wanted(side)) {
      continue;
    }
    MatchedMap& map = maps.of(side);
    if (!in_force_.refinement) {
      mark_unknown(map.disparity_px.view(), execution_, map.unmatched);
      continue;
    }
    refine_maps(*in_force_.refinement,
                {.side = side,
                 .image = photographs[index_of(side)],
                 .map = &map,
                 .search = in_force_.disparities},
                nullptr, execution_, work, [&](std::string_view step) { clock.start(step); });
  }
}

}  // namespace vantage
