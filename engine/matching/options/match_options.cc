#include "engine/matching/options/match_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/combinations/combinations.h"
#include "engine/error.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/options/match_presets.h"
#include "engine/matching/options/match_values.h"
#include "engine/matching/options/method_fields.h"
#include "engine/matching/options/method_names.h"
#include "engine/refinement/refinement_options.h"
#include "kernels/surface_fit/surface_fit.h"

namespace vantage {

static_assert(visits_every_field<RefinementOptions>(), "visit_fields() lacks a field");
static_assert(kernels::kMaxSurfaceRadiusPx == 16, "so say the limits of surface-fit");

namespace {

constexpr int kMaxDisparity = 65535;
constexpr double kMaxNoise = 64;  // grey levels

PresetSettings settings_of(const std::optional<MatchPreset>& preset,
                           NoiseKind kind = NoiseKind::kNone) {
  return preset ? preset_settings(*preset, kind) : PresetSettings{};
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
  validate_range("disparities-y", *y);
  const long long pairs = static_cast<long long>(x.count()) * y->count();
  if (pairs > kMaxCandidates) {
    throw UsageError(fmt::format(
        "disparities-y is {}:{} ({} candidates with disparities {}:{}), expected at most {}",
        y->min, y->max, pairs, x.min, x.max, kMaxCandidates));
  }
}

void validate_part(const std::optional<ImageRegion>& roi, double scale) {
  if (!(scale > 0 && scale <= 1)) {
    throw UsageError(fmt::format("scale is {}, expected a number above 0, at most 1", scale));
  }
  if (!roi) {
    return;
  }
  const auto [x, y, width, height] = *roi;
  const auto is_length = [](int px, int min) { return px >= min && px <= kMaxDisparity; };
  if (!is_length(x, 0) || !is_length(y, 0) || !is_length(width, 1) || !is_length(height, 1)) {
    throw UsageError(
        fmt::format("roi is {},{},{},{}, expected X,Y,W,H with X and Y from 0, W and "
                    "H from 1, to {}",
                    x, y, width, height, kMaxDisparity));
  }
}

/// The values in force by option.
OptionValues values_of(const MatchOptions& options, const MethodParameters& in_force,
                       const RefinementOptions& of_maps) {
  OptionValues values = values_of(in_force, options.parameters);
  const RefinementOverrides& set = options.refinement;
  visit_fields(
      [&](const RefinementField& field, const auto& value, const auto& chosen) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, bool>) {
          values.set(field.option, value ? "on" : "none", chosen.has_value());
        } else if constexpr (std::is_enum_v<Value>) {
          values.set(field.option, name_of(value), chosen.has_value());
        } else {
          values.set(field.option, value, chosen.has_value());
        }
      },
      of_maps, set);
  if (set.cross_check_px) {
    values.set("cross-check PX", *set.cross_check_px, true);
    values.set("cross-check", of_maps.cross_check ? "on" : "none", true);
  }
  if (options.method) {
    values.set("method", name_of(*options.method));
  }
  if (options.preset) {
    values.set("preset", name_of(*options.preset));
  }
  if (options.disparities_y) {
    values.set("disparities-y", "given");
  }
  if (options.raw) {
    values.set("raw", 1);
  }
  if (options.roi) {
    values.set("roi", "given", true);
  }
  values.set("scale", options.scale, options.scale != 1);
  return values;
}

/// What the user did not set gives way to what it does not go with.
template <typename Options>
void give_way(const OptionValues& values, Options& options) {
  for (const Combination& row : combinations()) {
    const OptionValues::Value* const value = values.find(row.option.option);
    if (!row.gives_way_to || value == nullptr || value->is_set || row.case_of(values) == nullptr) {
      continue;
    }
    visit_fields(
        [&](const auto& field, auto& in_force) {
          using Value = std::remove_cvref_t<decltype(in_force)>;
          // Of an option with two fields, the truth.
          const bool is_meant = field.option != "cross-check" || std::is_same_v<Value, bool>;
          if (field.option == row.option.option && is_meant) {
            in_force = static_cast<Value>(*row.gives_way_to);
          }
        },
        options);
  }
}

}  // namespace

int candidate_count(DisparityRange disparities, const MethodParameters& parameters) {
  return steps_per_px(parameters) * (disparities.count() - 1) + 1;
}

void MatchOptions::validate() const {
  const MethodParameters in_force = resolved();
  vantage::validate(in_force);
  validate_candidates(disparities_auto ? DisparityRange{0, 0} : disparities, disparities_y,
                      in_force);
  // Counts the candidates, which may be too many for an int until they are checked.
  const RefinementOptions of_maps = resolved_refinement();
  require_within_limits(of_maps);
  if (noise && !(*noise >= 0 && *noise <= kMaxNoise)) {
    throw UsageError(
        fmt::format("noise is {}, expected auto, none or a number of grey levels from 0 to {}",
                    *noise, kMaxNoise));
  }
  validate_part(roi, scale);
  refuse_combinations(CombinationScope::kMatch, values_of(*this, in_force, of_maps));
  require_read(parameters, in_force, chosen());
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

std::optional<double> MatchOptions::noise_in_force() const {
  return noise || preset_in_force() ? noise : std::optional(0.0);
}

MethodParameters MatchOptions::resolved(NoiseKind kind) const {
  PresetSettings settings = settings_of(preset_in_force(), kind);
  if (parameters.cost && parameters.cost != settings.parameters.cost) {
    settings.parameters.sigma_measurement.reset();  // it is in units of the preset's cost
  }
  MethodParameters result =
      resolve(method.value_or(settings.method), merge(settings.parameters, parameters));
  give_way(values_of(*this, result, {}), result);
  if (!parameters.candidate_blocks) {
    // A block is a number of candidates: the same disparities in pixels need more blocks.
    result.candidate_blocks =
        std::min(kMaxCandidateBlocks, result.candidate_blocks * steps_per_px(result));
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
  give_way(values_of(*this, resolved(), result), result);
  return result;
}

ResolvedMatchOptions MatchOptions::in_force() const {
  return {.disparities = disparities,
          .disparities_y = disparities_y,
          .parameters = resolved(),
          .refinement = raw ? std::nullopt : std::optional(resolved_refinement()),
          .noise = noise_in_force(),
          .parameters_of = {resolved(), resolved(NoiseKind::kSensor), resolved(NoiseKind::kCodec)},
          .roi = roi,
          .scale = scale};
}

MatchOptions MatchOptions::fully_resolved() const {
  MatchOptions result = *this;
  result.method = method.value_or(settings_of(preset_in_force()).method);
  result.preset.reset();
  result.noise = noise_in_force();
  result.parameters = as_overrides(resolved());
  result.refinement = all_set<RefinementOverrides>(resolved_refinement());
  return result;
}

OptionValues values_of(const MatchOptions& options) {
  OptionValues values = values_of(options, options.resolved(), options.resolved_refinement());
  values.chosen = options.chosen();
  values.set("reference", options.reference == Side::kLeft ? "left" : "right");
  return values;
}

}  // namespace vantage
