#include "engine/matching/options/method_rules.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "engine/error.h"
#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/matching/costs/cost_table.h"
#include "engine/matching/levels/energy_format.h"
#include "engine/matching/options/method_fields.h"
#include "engine/matching/options/method_names.h"
#include "engine/word_list.h"

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

void validate_pruning(const MethodParameters& parameters) {
  const int blocks = parameters.candidate_blocks;
  if (blocks == 0) {
    return;
  }
  require(parameters.levels > 1, "candidate-blocks", blocks,
          "0 with a single level: candidates are chosen by the winners of a coarser level");
  require(has_likelihoods(parameters), "candidate-blocks", blocks,
          "0 unless aggregation is bayes: for energies, candidates that were not searched have no "
          "value that is neutral to their neighbours");
  require(
      !is_evidence(parameters), "candidate-blocks", blocks,
      fmt::format("0 with the cost {}: its likelihoods compare a candidate with the best of all",
                  cost_of(parameters).name));
  require(parameters.prior_smoothing == PriorSmoothing::kMaximum, "candidate-blocks", blocks,
          "0 with prior-smoothing sum: pruning needs prior-smoothing maximum");
  require(parameters.prior != Prior::kQuadratic, "candidate-blocks", blocks,
          "0 with prior quadratic: it is unbounded, so unsearched candidates have no finite cost");
  require(parameters.selection == Selection::kWinner, "candidate-blocks", blocks,
          fmt::format("0 with selection {}: a path along a row needs the costs of all candidates",
                      name_of(parameters.selection)));
}

void validate_search_size(const MethodParameters& parameters) {
  if (parameters.search_size != SearchSize::kFull) {
    require(parameters.final_iterations > 0, "final-iterations", parameters.final_iterations,
            "at least 1 with a reduced search-size, whose full-size candidates need them");
  }
}

void validate_windows(const MethodParameters& parameters) {
  if (parameters.window_levels > 0) {
    require(
        can_search_windows(parameters), "window-levels", parameters.window_levels,
        "0; a search in windows needs aggregation bayes, levels above 1, prior-smoothing maximum, "
        "a prior other than quadratic, selection winner, candidate-step 1 and cost census-rays "
        "of luma");
    require(parameters.final_iterations > 0, "final-iterations", parameters.final_iterations,
            "at least 1 with window-levels above 0");
    require(parameters.window_levels < 2 || parameters.iterations > 0, "iterations",
            parameters.iterations, "at least 1 with window-levels 2");
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

void validate_combination(const MethodParameters& parameters) {
  if (parameters.aggregation == Aggregation::kLocalStopping &&
      parameters.certainty == Certainty::kMargin && is_evidence(parameters)) {
    throw UsageError(
        fmt::format("certainty margin divides by the sum of a pixel's costs, which for the cost {} "
                    "have both signs; expected certainty entropy",
                    cost_of(parameters).name));
  }
  if (parameters.estimate_sigma_measurement && uses_sigma_measurement(parameters) &&
      cost_of(parameters).unit != ResidualUnit::kGreyLevels) {
    std::vector<std::string_view> others;
    for (const MatchingCost& cost : cost_table()) {
      if (cost.unit != ResidualUnit::kGreyLevels) {
        others.push_back(cost.name);
      }
    }
    throw UsageError(
        fmt::format("sigma-measurement is estimated, which gives grey levels, but the costs {} are "
                    "none; expected a number",
                    word_list(others, "and")));
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
  return parameters.selection == Selection::kWinner && parameters.levels > 1 &&
         has_likelihoods(parameters) && !is_evidence(parameters) && uses_fixed_energies(parameters);
}

bool can_search_windows(const MethodParameters& parameters) {
  return parameters.selection == Selection::kWinner && parameters.levels > 1 &&
         uses_fixed_energies(parameters) && parameters.cost == MatchCost::kRayCensus &&
         parameters.colour == ColourUse::kLuma && steps_per_px(parameters) == 1;
}

bool can_reduce_search(const MethodParameters& parameters) {
  return can_search_windows(parameters) && parameters.census_thresholds == 1;
}

bool uses_sigma_measurement(const MethodParameters& parameters) {
  constexpr std::string_view kOption = "sigma-measurement";
  const bool is_idle = parameters.aggregation == Aggregation::kLocalStopping &&
                       parameters.certainty == Certainty::kMargin;
  return cost_of(parameters).reads(kOption) ||
         (aggregation_of(parameters).reads(kOption) && !is_idle);
}

bool uses_pair_exposure(const MethodParameters& parameters) {
  return (parameters.match_exposure && cost_of(parameters).reads("match-exposure")) ||
         (parameters.estimate_sigma_measurement && uses_sigma_measurement(parameters));
}

void validate(const MethodParameters& parameters) {
  require_within_limits(parameters);
  validate_pruning(parameters);
  validate_search_size(parameters);
  validate_windows(parameters);
  validate_step(parameters);
  validate_combination(parameters);
}

}  // namespace vantage
