#include "engine/matching/options/method_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "engine/combinations/combinations.h"
#include "engine/error.h"
#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/options/method_fields.h"

namespace vantage {
namespace {

// Defaults of selection scanline (perf/log/2026-11-25-selection.md). Energies of Bayes are −ln p.
constexpr double kBayesJumpLimit = 15;
constexpr double kJumpPenaltyShare = 0.25;
// Of selection symmetric.
constexpr double kBayesOcclusionPenalty = 5;

// σM of gradient evidence under local stopping, in grey levels per pixel of slope
// (perf/log/2026-11-25-diffusions.md).
constexpr double kEvidenceSigmaOfSlope = 0.25;

/// Response of a derivative filter to a slope of one grey level per pixel (EQUATIONS §2).
double slope_response(GradientFilter filter) {
  switch (filter) {
    case GradientFilter::kCentral:
      return 2;
    case GradientFilter::kForward:
      return 1;
    case GradientFilter::kSobel:
      return 8;
    case GradientFilter::kSimoncelli3:
      return 0.91;
    case GradientFilter::kSimoncelli5:
      return 1;
  }
  return 1;
}

MatchCost natural_cost(Aggregation aggregation) { return aggregation_of(aggregation).natural_cost; }

void require(bool holds, std::string_view field, double value, std::string_view expected) {
  if (!holds) {
    throw UsageError(fmt::format("{} is {}, expected {}", field, value, expected));
  }
}

void validate_step(const MethodParameters& parameters) {
  if (parameters.aggregation == Aggregation::kMembrane) {
    const double max = 1 / (4 + parameters.beta);
    require(parameters.lambda > 0 && parameters.lambda <= max, "lambda", parameters.lambda,
            fmt::format("a number above 0 and at most 1/(4 + beta) = {:.4g}: larger steps of the "
                        "membrane are unstable",
                        max));
  } else if (parameters.aggregation != Aggregation::kBayes) {
    require(parameters.lambda > 0 && parameters.lambda < 0.25, "lambda", parameters.lambda,
            "a number above 0 and below 0.25: larger steps of diffusion are unstable");
  }
}

/// Penalties of selections that are not set: what measurement says for the unit of the aggregated
/// costs.
void set_penalty_defaults(const MethodOverrides& overrides, MethodParameters& parameters) {
  if (!overrides.jump_limit) {
    parameters.jump_limit =
        has_likelihoods(parameters) ? kBayesJumpLimit : cost_of(parameters).jump_limit;
  }
  if (!overrides.jump_penalty) {
    parameters.jump_penalty = std::isinf(parameters.jump_limit)
                                  ? kJumpPenaltyShare * cost_of(parameters).jump_limit
                                  : kJumpPenaltyShare * parameters.jump_limit;
  }
  if (!overrides.occlusion_penalty) {
    parameters.occlusion_penalty = has_likelihoods(parameters)
                                       ? kBayesOcclusionPenalty
                                       : cost_of(parameters).occlusion_penalty;
  }
}

}  // namespace

MethodParameters book_parameters(MatchMethod method) {
  MethodParameters parameters;
  switch (method) {
    case MatchMethod::kSsd:
      break;
    case MatchMethod::kGradient:
      parameters.cost = MatchCost::kGradient;
      parameters.aggregation = Aggregation::kBoxCascade;
      break;
    case MatchMethod::kDiffusion:
      parameters.aggregation = Aggregation::kDiffusion;
      break;
    case MatchMethod::kMembrane:
      parameters.aggregation = Aggregation::kMembrane;
      break;
    case MatchMethod::kLocalStopping:
      parameters.aggregation = Aggregation::kLocalStopping;
      break;
    case MatchMethod::kBayes:
      parameters.cost = MatchCost::kContaminated;
      parameters.aggregation = Aggregation::kBayes;
      break;
  }
  set_penalty_defaults({}, parameters);
  return parameters;
}

MethodOverrides merge(const MethodOverrides& defaults, const MethodOverrides& overrides) {
  MethodOverrides result = defaults;
  take_over(overrides, result);
  return result;
}

MethodOverrides as_overrides(const MethodParameters& parameters) {
  return all_set<MethodOverrides>(parameters);
}

MethodParameters resolve(MatchMethod method, const MethodOverrides& overrides) {
  MethodParameters result = book_parameters(method);
  if (overrides.aggregation && *overrides.aggregation != result.aggregation &&
      result.cost == natural_cost(result.aggregation)) {
    result.cost = natural_cost(*overrides.aggregation);
  }
  take_over(overrides, result);
  if (!overrides.final_iterations) {
    result.final_iterations = result.iterations;
  }
  if (!overrides.sigma_measurement && result.aggregation == Aggregation::kLocalStopping &&
      is_evidence(result)) {
    result.sigma_measurement = kEvidenceSigmaOfSlope * slope_response(result.gradient);
  }
  set_penalty_defaults(overrides, result);
  return result;
}

bool can_prune(const MethodParameters& parameters) {
  const OptionValues values = values_of(parameters, {});
  return std::ranges::none_of(combinations(), [&](const Combination& row) {
    return row.scope == CombinationScope::kMethod && row.option.option == "candidate-blocks" &&
           !none_holds(row.with, values);
  });
}

bool can_search_windows(const MethodParameters& parameters) {
  static const std::vector<Condition> obstacles = conditions(kObstaclesOfWindows);
  return none_holds(obstacles, values_of(parameters, {}));
}

bool can_reduce_search(const MethodParameters& parameters) {
  static const std::vector<Condition> obstacles = conditions(kObstaclesOfReducedSearch);
  return none_holds(obstacles, values_of(parameters, {}));
}

bool uses_sigma_measurement(const MethodParameters& parameters) {
  constexpr std::string_view kOption = "sigma-measurement";
  const bool is_idle = parameters.aggregation == Aggregation::kLocalStopping &&
                       parameters.certainty == Certainty::kMargin;
  return cost_of(parameters).reads(kOption) ||
         (aggregation_of(parameters).reads(kOption) && !is_idle);
}

void validate(const MethodParameters& parameters) {
  require_within_limits(parameters);
  validate_step(parameters);
  refuse_combinations(CombinationScope::kMethod, values_of(parameters, {}));
}

}  // namespace vantage
