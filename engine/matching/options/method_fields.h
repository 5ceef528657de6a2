#pragma once

#include <cmath>
#include <concepts>
#include <string_view>
#include <type_traits>

#include "engine/combinations/option_values.h"
#include "engine/matching/options/method_rules.h"
#include "engine/matching/options/parameter_readers.h"
#include "engine/option_field.h"

namespace vantage {

/// Description of a field of MethodParameters.
struct MethodField {
  std::string_view option;  ///< its name on the command line, in files and in messages
  ParameterReaders readers;
  Limits limits = {};  ///< those that do not depend on other fields

  /// Whether results of these parameters can depend on this field.
  [[nodiscard]] bool is_read(const MethodParameters& in_force) const {
    return readers.are_in_force(in_force, option);
  }
};

template <typename T>
concept MethodOptions = std::same_as<std::remove_const_t<T>, MethodOverrides> ||
    std::same_as<std::remove_const_t<T>, MethodParameters>;

/// Limits of several fields.
namespace method_limits {

inline constexpr auto is_positive = [](double v) { return v > 0 && std::isfinite(v); };
inline constexpr auto is_not_negative = [](double v) { return v >= 0 && std::isfinite(v); };
inline constexpr auto is_probability = [](double v) { return v > 0 && v < 1; };
inline constexpr auto is_weight = [](double v) { return v > 0 && v <= 1; };
inline constexpr auto is_limit = [](double v) { return v >= 0; };
// 181² · 255² is the largest windowed sum of squares that fits 31 bits.
inline constexpr auto is_window = [](double v) {
  return is_within<1, 181>(v) && static_cast<int>(v) % 2 == 1;
};
inline constexpr Limits kGreyLevels = {is_positive, "a number of grey levels above 0"};
inline constexpr Limits kProbability = {is_probability, "a number between 0 and 1, both excluded"};
inline constexpr Limits kNotNegative = {is_not_negative, "a number of at least 0"};
inline constexpr Limits kIterations = {is_within<0, 10000>, "a number from 0 to 10000"};
inline constexpr Limits kLevels = {is_within<1, 10>, "a number from 1 to 10"};

}  // namespace method_limits

/// The part of visit_fields() about costs.
template <typename Visit, MethodOptions... Options>
constexpr void visit_cost_fields(const Visit& visit, Options&... options) {
  using Field = MethodField;
  using namespace method_limits;
  visit(Field{"cost", readers::kAll}, options.cost...);
  visit(Field{"colour", readers::kAll}, options.colour...);
  visit(Field{"truncation", readers::kCosts, kGreyLevels}, options.truncation...);
  visit(Field{"sigma-measurement", readers::kSigmaMeasurement, kGreyLevels},
        options.sigma_measurement...);
  visit(Field{"epsilon-measurement", readers::kEpsilonMeasurement, kProbability},
        options.epsilon_measurement...);
  visit(Field{"census-thresholds",
              readers::kCosts,
              {[](double v) { return v == 1 || v == 3; }, "1 or 3"}},
        options.census_thresholds...);
  visit(Field{"alpha", readers::kGradient, kNotNegative}, options.alpha...);
  visit(Field{"gradient-components", readers::kGradient}, options.gradient_components...);
  visit(Field{"norm", readers::kGradientNorm}, options.norm...);
  visit(Field{"gradient", readers::kGradient}, options.gradient...);
  visit(Field{"prefilter", readers::kGradient}, options.prefilter...);
}

/// About aggregation.
template <typename Visit, MethodOptions... Options>
constexpr void visit_aggregation_fields(const Visit& visit, Options&... options) {
  using Field = MethodField;
  using namespace method_limits;
  visit(Field{"aggregate", readers::kAll}, options.aggregation...);
  visit(Field{"window", readers::kBox, {is_window, "an odd number from 1 to 181"}},
        options.window_px...);
  visit(Field{"border", readers::kBox}, options.border...);
  visit(Field{"aggregation-sigma",
              readers::kGaussians,
              {[](double v) { return v >= 0.5 && v <= 16; }, "a number of pixels from 0.5 to 16"}},
        options.aggregation_sigma_px...);
  visit(Field{"iterations", readers::kNamed, kIterations}, options.iterations...);
  visit(Field{"levels", readers::kAll, kLevels}, options.levels...);
  visit(Field{"search-size", readers::kSearchSize}, options.search_size...);
  visit(Field{"candidate-blocks",
              readers::kCandidateBlocks,
              {is_within<0, kMaxCandidateBlocks>, "a number from 0 (all candidates) to 8"}},
        options.candidate_blocks...);
  visit(Field{"pruned-levels", readers::kPrunedLevels, kLevels}, options.pruned_levels...);
  visit(Field{"window-levels", readers::kWindowLevels, {is_within<0, 1>, "0 or 1"}},
        options.window_levels...);
  visit(Field{"final-iterations", readers::kNamedWithLevels, kIterations},
        options.final_iterations...);
  visit(Field{"lambda", readers::kNamed}, options.lambda...);
  visit(Field{"beta", readers::kNamed, kNotNegative}, options.beta...);
  visit(Field{"certainty", readers::kNamed}, options.certainty...);
  visit(Field{"mu",
              readers::kBayes,
              {is_weight,
               "a number above 0 and at most 1: larger weights of the neighbours are unstable"}},
        options.mu...);
  visit(Field{"prior", readers::kBayes}, options.prior...);
  visit(Field{"sigma-prior", readers::kSigmaPrior, {is_positive, "a number of pixels above 0"}},
        options.sigma_prior...);
  visit(Field{"epsilon-prior", readers::kEpsilonPrior, kProbability}, options.epsilon_prior...);
  visit(Field{"prior-growth", readers::kPriorGrowth, {is_within<1, 4>, "a number from 1 to 4"}},
        options.prior_growth...);
  visit(Field{"prior-smoothing", readers::kBayes}, options.prior_smoothing...);
  visit(
      Field{
          "level-weight", readers::kBayesWithLevels, {is_weight, "a number above 0 and at most 1"}},
      options.level_weight...);
  visit(Field{"slant-penalty",
              readers::kBayesWithLevels,
              {is_limit, "a number of at least 0, or none"}},
        options.slant_penalty...);
  visit(Field{"edge-weight", readers::kNamed, {is_within<0, 1>, "a number from 0 to 1"}},
        options.edge_weight...);
  visit(Field{"edge-contrast", readers::kEdges, kGreyLevels}, options.edge_contrast...);
  visit(Field{"edge-diffusion", readers::kEdges, {is_within<0, 1000>, "a number from 0 to 1000"}},
        options.edge_diffusion...);
}

/// About the selection of winners.
template <typename Visit, MethodOptions... Options>
constexpr void visit_selection_fields(const Visit& visit, Options&... options) {
  using Field = MethodField;
  using namespace method_limits;
  visit(Field{"selection", readers::kAll}, options.selection...);
  visit(Field{"jump-limit", readers::kScanline, {is_limit, "a number of at least 0, or none"}},
        options.jump_limit...);
  visit(Field{"jump-penalty", readers::kScanline, kNotNegative}, options.jump_penalty...);
  visit(Field{"candidate-step",
              readers::kAll,
              {[](double v) { return v == 1 || v == 0.5 || v == 0.25; }, "1, 0.5 or 0.25 pixels"}},
        options.candidate_step_px...);
  visit(Field{"occlusion-penalty", readers::kSymmetric, {is_positive, "a number above 0"}},
        options.occlusion_penalty...);
  visit(Field{"subpixel", readers::kAll}, options.subpixel...);
}

/// Calls visit(MethodField, options.field...) for every field, in the order of the options.
template <typename Visit, MethodOptions... Options>
constexpr void visit_fields(const Visit& visit, Options&... options) {
  visit_cost_fields(visit, options...);
  visit_aggregation_fields(visit, options...);
  visit_selection_fields(visit, options...);
}

/// The values in force by option; those that the cost and the aggregation do not read are not
/// given.
OptionValues values_of(const MethodParameters& in_force, const MethodOverrides& set);

/// Throws UsageError for the first parameter that `overrides` sets but nothing reads under
/// `in_force`. `chosen`: describes `in_force` in words.
void require_read(const MethodOverrides& overrides, const MethodParameters& in_force,
                  std::string_view chosen);

}  // namespace vantage
