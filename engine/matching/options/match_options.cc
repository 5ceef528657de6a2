#include "engine/matching/options/match_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "engine/error.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/options/match_presets.h"
#include "engine/matching/options/method_fields.h"
#include "engine/matching/options/method_names.h"
#include "engine/refinement/refinement_options.h"
#include "kernels/surface_fit/surface_fit.h"

namespace vantage {

static_assert(visits_every_field<RefinementOptions>(), "visit_fields() lacks a field");
static_assert(kernels::kMaxSurfaceRadiusPx == 16, "so say the limits of surface-fit");

namespace {

constexpr int kMaxDisparity = 65535;

PresetSettings settings_of(const std::optional<MatchPreset>& preset) {
  return preset ? preset_settings(*preset) : PresetSettings{};
}

void validate_range(std::string_view field, DisparityRange range) {
  if (range.max < range.min) {
    throw UsageError(
        fmt::format("{} is {}:{}, expected MIN:MAX with MIN <= MAX", field, range.min, range.max));
  }
  if (range.min < -kMaxDisparity || range.max > kMaxDisparity) {
    throw UsageError(fmt::format("{} is {}:{}, expected values within ±{}", field, range.min,
                                 range.max, kMaxDisparity));
  }
}

void validate_candidates(DisparityRange x, const std::optional<DisparityRange>& y,
                         const MethodParameters& parameters) {
  validate_range("disparities", x);
  if (const int count = candidate_count(x, parameters); count > kMaxCandidates) {
    throw UsageError(fmt::format(
        "disparities is {}:{} ({} candidates{}), expected at most {}", x.min, x.max, count,
        steps_per_px(parameters) > 1 ? fmt::format(" {} px apart", parameters.candidate_step_px)
                                     : "",
        kMaxCandidates));
  }
  if (!y) {
    return;
  }
  if (steps_per_px(parameters) > 1) {
    throw UsageError(
        fmt::format("candidate-step is {}, expected 1 with disparities-y: displacements are of "
                    "whole pixels",
                    parameters.candidate_step_px));
  }
  validate_range("disparities-y", *y);
  const long long pairs = static_cast<long long>(x.count()) * y->count();
  if (pairs > kMaxCandidates) {
    throw UsageError(fmt::format(
        "disparities-y is {}:{} ({} candidates with disparities {}:{}), expected at most {}",
        y->min, y->max, pairs, x.min, x.max, kMaxCandidates));
  }
}

void validate_refinement(const RefinementOptions& refinement, bool is_two_dimensional) {
  require_within_limits(refinement);
  if (refinement.edge_snapping_px > 0 && is_two_dimensional) {
    throw UsageError(fmt::format(
        "edge-snapping is {}, expected 0 with disparities-y: it moves discontinuities of "
        "horizontal disparities only",
        refinement.edge_snapping_px));
  }
}

/// With a search in reduced images.
void validate_reduced_search(const MethodParameters& parameters,
                             const RefinementOptions& refinement, bool is_two_dimensional) {
  const auto refuse = [](std::string_view field, int value, std::string_view why) {
    throw UsageError(
        fmt::format("{} is {}, expected 0 with a reduced search-size: {}", field, value, why));
  };
  if (is_two_dimensional || !can_reduce_search(parameters)) {
    throw UsageError(
        "search-size is not full, expected full: a reduced search-size needs a search along rows, "
        "aggregation bayes, levels above 1, prior-smoothing maximum, a prior other than quadratic, "
        "selection winner, candidate-step 1, and cost census-rays with one threshold and colour "
        "luma");
  }
  if (refinement.edge_snapping_px > 0) {
    refuse("edge-snapping", refinement.edge_snapping_px,
           "maps are enlarged along the image's edges instead");
  }
  if (refinement.cross_check_level > 0) {
    refuse("cross-check-level", refinement.cross_check_level, "both maps have half the size");
  }
}

/// Throws UsageError for the first field that is set but not read by refinement.
void require_read(const RefinementOverrides& set, const RefinementOptions& in_force, bool raw) {
  const auto refuse_if = [](bool is_unread, std::string_view field, std::string_view why) {
    if (is_unread) {
      throw UsageError(fmt::format("{} is set but has no effect with {}", field, why));
    }
  };
  visit_fields(
      [&](const RefinementField& field, const auto& value) {
        refuse_if(raw && value, field.option, "raw, which leaves all refinement out");
      },
      set);
  constexpr std::string_view kUnchecked = "cross-check none";
  refuse_if(!in_force.cross_check && set.cross_check_px, "a number of pixels for cross-check",
            kUnchecked);
  refuse_if(!in_force.cross_check && set.cross_check_level.value_or(0) > 0, "cross-check-level",
            kUnchecked);
  const double contrast = RefinementOptions{}.uniform_contrast;
  refuse_if(
      !fills_uniform_regions(in_force.fill) && set.uniform_contrast.value_or(contrast) != contrast,
      "uniform-contrast", "a fill other than canonical and thin-plate");
  refuse_if(in_force.surface_fit_px == 0 && set.surface_fit_step_px.value_or(1) > 1,
            "surface-fit-step", "surface-fit 0");
}

}  // namespace

int candidate_count(DisparityRange disparities, const MethodParameters& parameters) {
  return steps_per_px(parameters) * (disparities.count() - 1) + 1;
}

bool can_check_levels(const MethodParameters& parameters) {
  return parameters.selection == Selection::kWinner && parameters.levels > 1 &&
         parameters.aggregation == Aggregation::kBayes;
}

void MatchOptions::validate() const {
  if (method && preset) {
    throw UsageError("method and preset are both set, expected one of them: a preset has a method");
  }
  const MethodParameters in_force = resolved();
  vantage::validate(in_force);
  validate_candidates(disparities_auto ? DisparityRange{0, 0} : disparities, disparities_y,
                      in_force);
  if (in_force.candidate_blocks > 0 && disparities_y) {
    throw UsageError(fmt::format(
        "candidate-blocks is {}, expected 0 with disparities-y: blocks are of candidates along "
        "rows",
        in_force.candidate_blocks));
  }
  if (in_force.selection != Selection::kWinner && disparities_y) {
    throw UsageError(
        fmt::format("selection is {}, expected winner with disparities-y: paths are along rows",
                    name_of(in_force.selection)));
  }
  if (in_force.window_levels > 0 && disparities_y) {
    throw UsageError(
        fmt::format("window-levels is {}, expected 0 with disparities-y: windows are of candidates "
                    "along rows",
                    in_force.window_levels));
  }
  if (std::isfinite(in_force.slant_penalty) && disparities_y) {
    throw UsageError(
        fmt::format("slant-penalty is {}, expected none with disparities-y: surfaces slant along "
                    "one range only",
                    in_force.slant_penalty));
  }
  const RefinementOptions of_maps = resolved_refinement();
  if (in_force.selection == Selection::kSymmetric && refinement.cross_check.value_or(false)) {
    throw UsageError(
        "cross-check is on, expected none with selection symmetric: both maps are of one solution");
  }
  if (in_force.selection == Selection::kSymmetric && in_force.candidate_step_px < 1) {
    throw UsageError(fmt::format(
        "candidate-step is {}, expected 1 with selection symmetric: it matches whole pixels",
        in_force.candidate_step_px));
  }
  validate_refinement(of_maps, disparities_y.has_value());
  if (of_maps.cross_check_level > 0 && disparities_y) {
    throw UsageError(fmt::format(
        "cross-check-level is {}, expected 0 with disparities-y: winners of coarse levels are kept "
        "of searches along rows only",
        of_maps.cross_check_level));
  }
  if (in_force.search_size != SearchSize::kFull) {
    validate_reduced_search(in_force, of_maps, disparities_y.has_value());
  }
  if (of_maps.cross_check_level > 0 && !can_check_levels(in_force)) {
    throw UsageError(fmt::format(
        "cross-check-level is {}, expected 0: only aggregation bayes with levels above 1 and "
        "selection winner has maps of coarse levels",
        of_maps.cross_check_level));
  }
  require_read(parameters, in_force, chosen());
  require_read(refinement, of_maps, raw);
}

std::optional<MatchPreset> MatchOptions::preset_in_force() const {
  if (preset || method || parameters.aggregation || disparities_y) {
    return preset;
  }
  return MatchPreset::kBalanced;
}

std::string MatchOptions::chosen() const {
  const std::optional<MatchPreset> in_force = preset_in_force();
  std::string text = in_force
                         ? fmt::format("preset {}", name_of(*in_force))
                         : fmt::format("method {}", name_of(method.value_or(MatchMethod::kSsd)));
  std::string_view separator = " with ";
  if (parameters.cost) {
    text += fmt::format("{}cost {}", separator, name_of(*parameters.cost));
    separator = " and ";
  }
  if (parameters.aggregation) {
    text += fmt::format("{}aggregation {}", separator, name_of(*parameters.aggregation));
  }
  return text;
}

MethodParameters MatchOptions::resolved() const {
  PresetSettings settings = settings_of(preset_in_force());
  if (parameters.cost && parameters.cost != settings.parameters.cost) {
    settings.parameters.sigma_measurement.reset();  // it is in units of the preset's cost
  }
  MethodParameters result =
      resolve(method.value_or(settings.method), merge(settings.parameters, parameters));
  // A preset's search size, windows and pruning apply only where they are possible: the user's
  // choices take precedence.
  if (!parameters.search_size && (disparities_y || !can_reduce_search(result))) {
    result.search_size = SearchSize::kFull;
  }
  const bool chooses_blocks = parameters.candidate_blocks || parameters.pruned_levels;
  if (!parameters.window_levels && (disparities_y || chooses_blocks ||
                                    result.final_iterations == 0 || !can_search_windows(result))) {
    result.window_levels = 0;
  }
  if (!parameters.candidate_blocks && (disparities_y || !can_prune(result))) {
    result.candidate_blocks = 0;
  }
  if (!parameters.candidate_blocks) {
    // A block is a number of candidates: the same disparities in pixels need more blocks.
    result.candidate_blocks =
        std::min(kMaxCandidateBlocks, result.candidate_blocks * steps_per_px(result));
  }
  if (!parameters.slant_penalty && disparities_y) {
    result.slant_penalty = std::numeric_limits<double>::infinity();
  }
  return result;
}

RefinementOptions MatchOptions::resolved_refinement() const {
  RefinementOptions result;
  result.cross_check_px = std::max(1.0, disparities.count() / 15.0);
  if (is_evidence(resolved())) {
    result.confidence_threshold = 0;
  }
  take_over(settings_of(preset_in_force()).refinement, result);
  take_over(refinement, result);
  if (!refinement.cross_check && resolved().selection == Selection::kSymmetric) {
    result.cross_check = false;
  }
  // As with pruning: a preset's cross-check level applies only where it is possible.
  if (!refinement.cross_check_level && (disparities_y || !can_check_levels(resolved()))) {
    result.cross_check_level = 0;
  }
  return result;
}

ResolvedMatchOptions MatchOptions::in_force() const {
  return {.disparities = disparities,
          .disparities_y = disparities_y,
          .parameters = resolved(),
          .refinement = raw ? std::nullopt : std::optional(resolved_refinement())};
}

MatchOptions MatchOptions::fully_resolved() const {
  MatchOptions result = *this;
  result.method = method.value_or(settings_of(preset_in_force()).method);
  result.preset.reset();
  result.parameters = as_overrides(resolved());
  result.refinement = all_set<RefinementOverrides>(resolved_refinement());
  return result;
}

}  // namespace vantage
