#include "engine/matching/options/method_parameters.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "engine/error.h"
#include "kernels/census/census.h"

namespace vantage {
namespace {

// 181² · 255² is the largest windowed sum of squares that fits 31 bits.
constexpr int kMaxWindow = 181;
constexpr int kMaxIterations = 10000;
constexpr int kMaxLevels = 10;
constexpr double kMaxPriorGrowth = 4;
constexpr double kMaxAggregationSigma = 16;

constexpr MethodParameters kCommon{
    .cost = MatchCost::kSquared,
    .aggregation = Aggregation::kBox,
    .colour = ColourUse::kLuma,
    .match_exposure = false,
    .subpixel = Subpixel::kParabola,
    .border = Border::kClip,
    .window_px = 9,
    .aggregation_sigma_px = 2,
    .iterations = 10,
    .levels = 1,
    .candidate_blocks = 0,
    .pruned_levels = 2,
    .final_iterations = 10,
    .lambda = 0.15,
    .beta = 0.5,
    .certainty = Certainty::kMargin,
    .mu = 0.5,
    .sigma_prior = 0.4,
    .epsilon_prior = 0.01,
    .sigma_measurement = 5,
    .estimate_sigma_measurement = false,
    .epsilon_measurement = 0.1,
    .census_thresholds = 1,
    .sigma_census = 0.2,
    .sigma_gradient = 0,
    .prior_growth = 1,
    .prior_smoothing = PriorSmoothing::kSum,
    .level_weight = 1,
    .edge_weight = 1,
    .edge_contrast = 8,
    .truncation = 20,
    .alpha = 1,
    .norm = GradientNorm::kL2,
    .gradient = GradientFilter::kCentral,
    .prefilter = true,
};

MatchCost natural_cost(Aggregation aggregation) {
  return aggregation == Aggregation::kBayes ? MatchCost::kContaminated : MatchCost::kSquared;
}

template <typename T, typename Target>
void take(const std::optional<T>& override_value, Target& field) {
  if (override_value) {
    field = *override_value;
  }
}
template <typename T>
void take(const T& value, std::optional<T>& field) {
  field = value;
}

/// Gives `target` the fields that `overrides` have.
template <template <typename> class From, template <typename> class To>
void take_over(const MethodParametersOf<From>& overrides, MethodParametersOf<To>& target) {
  take(overrides.cost, target.cost);
  take(overrides.aggregation, target.aggregation);
  take(overrides.colour, target.colour);
  take(overrides.match_exposure, target.match_exposure);
  take(overrides.subpixel, target.subpixel);
  take(overrides.border, target.border);
  take(overrides.window_px, target.window_px);
  take(overrides.aggregation_sigma_px, target.aggregation_sigma_px);
  take(overrides.iterations, target.iterations);
  take(overrides.levels, target.levels);
  take(overrides.candidate_blocks, target.candidate_blocks);
  take(overrides.pruned_levels, target.pruned_levels);
  take(overrides.final_iterations, target.final_iterations);
  take(overrides.lambda, target.lambda);
  take(overrides.beta, target.beta);
  take(overrides.certainty, target.certainty);
  take(overrides.mu, target.mu);
  take(overrides.sigma_prior, target.sigma_prior);
  take(overrides.epsilon_prior, target.epsilon_prior);
  take(overrides.prior_growth, target.prior_growth);
  take(overrides.prior_smoothing, target.prior_smoothing);
  take(overrides.level_weight, target.level_weight);
  take(overrides.edge_weight, target.edge_weight);
  take(overrides.edge_contrast, target.edge_contrast);
  take(overrides.sigma_measurement, target.sigma_measurement);
  take(overrides.estimate_sigma_measurement, target.estimate_sigma_measurement);
  take(overrides.epsilon_measurement, target.epsilon_measurement);
  take(overrides.census_thresholds, target.census_thresholds);
  take(overrides.sigma_census, target.sigma_census);
  take(overrides.sigma_gradient, target.sigma_gradient);
  take(overrides.truncation, target.truncation);
  take(overrides.alpha, target.alpha);
  take(overrides.norm, target.norm);
  take(overrides.gradient, target.gradient);
  take(overrides.prefilter, target.prefilter);
}

void require(bool holds, std::string_view field, double value, std::string_view expected) {
  if (!holds) {
    throw UsageError(fmt::format("{} is {}, expected {}", field, value, expected));
  }
}

bool is_probability(double value) { return value > 0 && value < 1; }

bool is_positive(double value) { return value > 0 && std::isfinite(value); }

void validate_pruning(const MethodParameters& parameters) {
  const int blocks = parameters.candidate_blocks;
  require(blocks >= 0 && blocks <= kMaxCandidateBlocks, "candidate-blocks", blocks,
          fmt::format("a number from 0 (all candidates) to {}", kMaxCandidateBlocks));
  require(parameters.pruned_levels >= 1 && parameters.pruned_levels <= kMaxLevels, "pruned-levels",
          parameters.pruned_levels, fmt::format("a number from 1 to {}", kMaxLevels));
  if (blocks == 0) {
    return;
  }
  require(parameters.levels > 1, "candidate-blocks", blocks,
          "0 with a single level: candidates are chosen by the winners of a coarser level");
  require(parameters.aggregation == Aggregation::kBayes, "candidate-blocks", blocks,
          "0 but with the aggregation bayes: for energies, candidates that were not looked at have "
          "no value that is neutral to their neighbours");
  require(!is_evidence(parameters), "candidate-blocks", blocks,
          "0 with the cost gradient: its likelihoods compare a candidate with the best of all");
}

void validate_diffusion(const MethodParameters& parameters) {
  require(parameters.iterations >= 0 && parameters.iterations <= kMaxIterations, "iterations",
          parameters.iterations, fmt::format("a number from 0 to {}", kMaxIterations));
  require(parameters.levels >= 1 && parameters.levels <= kMaxLevels, "levels", parameters.levels,
          fmt::format("a number from 1 to {}", kMaxLevels));
  validate_pruning(parameters);
  require(parameters.final_iterations >= 0 && parameters.final_iterations <= kMaxIterations,
          "final-iterations", parameters.final_iterations,
          fmt::format("a number from 0 to {}", kMaxIterations));
  if (parameters.aggregation == Aggregation::kMembrane) {
    require(parameters.beta >= 0 && std::isfinite(parameters.beta), "beta", parameters.beta,
            "a number of at least 0");
    const double most = 1 / (4 + parameters.beta);
    require(parameters.lambda > 0 && parameters.lambda <= most, "lambda", parameters.lambda,
            fmt::format("a number above 0 and at most 1/(4 + beta) = {:.4g}: larger steps of the "
                        "membrane are unstable",
                        most));
  } else if (parameters.aggregation != Aggregation::kBayes) {
    require(parameters.lambda > 0 && parameters.lambda < 0.25, "lambda", parameters.lambda,
            "a number above 0 and below 0.25: larger steps of diffusion are unstable");
  }
}

void validate_bayes(const MethodParameters& parameters) {
  require(parameters.mu > 0 && parameters.mu <= 1, "mu", parameters.mu,
          "a number above 0 and at most 1: larger weights of the neighbours are unstable");
  require(is_positive(parameters.sigma_prior), "sigma-prior", parameters.sigma_prior,
          "a number of pixels above 0");
  require(is_probability(parameters.epsilon_prior), "epsilon-prior", parameters.epsilon_prior,
          "a number between 0 and 1, both excluded");
  require(parameters.prior_growth >= 1 && parameters.prior_growth <= kMaxPriorGrowth,
          "prior-growth", parameters.prior_growth,
          fmt::format("a number from 1 to {}", kMaxPriorGrowth));
  require(parameters.level_weight > 0 && parameters.level_weight <= 1, "level-weight",
          parameters.level_weight, "a number above 0 and at most 1");
  require(parameters.edge_weight >= 0 && parameters.edge_weight <= 1, "edge-weight",
          parameters.edge_weight, "a number from 0 to 1");
  require(is_positive(parameters.edge_contrast), "edge-contrast", parameters.edge_contrast,
          "a number of grey levels above 0");
}

void validate_combination(const MethodParameters& parameters) {
  if (parameters.aggregation == Aggregation::kLocalStopping &&
      parameters.certainty == Certainty::kMargin && is_evidence(parameters)) {
    throw UsageError(
        "certainty margin divides by the sum of a pixel's costs, which for the cost gradient have "
        "both signs; expected certainty entropy");
  }
  const bool is_in_grey_levels =
      parameters.cost != MatchCost::kGradient && !is_census(parameters.cost);
  if (parameters.estimate_sigma_measurement && uses_sigma_measurement(parameters) &&
      !is_in_grey_levels) {
    throw UsageError(
        "sigma-measurement is estimated, which gives grey levels, but the costs gradient, census "
        "and census-rays are none; expected a number");
  }
}

}  // namespace

MethodParameters book_parameters(MatchMethod method) {
  MethodParameters parameters = kCommon;
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
  return parameters;
}

MethodOverrides merge(const MethodOverrides& defaults, const MethodOverrides& overrides) {
  MethodOverrides result = defaults;
  take_over(overrides, result);
  return result;
}

MethodOverrides as_overrides(const MethodParameters& parameters) {
  MethodOverrides result;
  take_over(parameters, result);
  return result;
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
  // Combined costs are made for photographs, whose noise differs from pair to pair.
  if (!overrides.sigma_measurement && !overrides.estimate_sigma_measurement) {
    result.estimate_sigma_measurement = result.cost == MatchCost::kCombined;
  }
  return result;
}

bool can_prune(const MethodParameters& parameters) {
  return parameters.levels > 1 && parameters.aggregation == Aggregation::kBayes &&
         !is_evidence(parameters);
}

MethodParameters at_level(const MethodParameters& parameters, int level) {
  MethodParameters result = parameters;
  if (level == 0 && parameters.levels > 1) {
    result.iterations = parameters.final_iterations;
  }
  result.sigma_prior *= std::pow(parameters.prior_growth, level);
  return result;
}

bool uses_sigma_measurement(const MethodParameters& parameters) {
  return parameters.cost == MatchCost::kContaminated || parameters.cost == MatchCost::kCombined ||
         parameters.aggregation == Aggregation::kBayes ||
         (parameters.aggregation == Aggregation::kLocalStopping &&
          parameters.certainty == Certainty::kEntropy);
}

bool uses_pair_levels(const MethodParameters& parameters) {
  return (parameters.match_exposure && !is_census(parameters.cost)) ||
         (parameters.estimate_sigma_measurement && uses_sigma_measurement(parameters));
}

void validate(const MethodParameters& parameters) {
  const int window = parameters.window_px;
  require(window >= 1 && window <= kMaxWindow && window % 2 == 1, "window", window,
          fmt::format("an odd number from 1 to {}", kMaxWindow));
  require(parameters.aggregation_sigma_px >= 0.5 &&
              parameters.aggregation_sigma_px <= kMaxAggregationSigma,
          "aggregation-sigma", parameters.aggregation_sigma_px,
          fmt::format("a number of pixels from 0.5 to {}", kMaxAggregationSigma));
  require(is_positive(parameters.sigma_measurement), "sigma-measurement",
          parameters.sigma_measurement, "a number of grey levels above 0");
  require(is_probability(parameters.epsilon_measurement), "epsilon-measurement",
          parameters.epsilon_measurement, "a number between 0 and 1, both excluded");
  require(parameters.census_thresholds == 1 ||
              parameters.census_thresholds == kernels::kMostRayCensusThresholds,
          "census-thresholds", parameters.census_thresholds, "1 or 3");
  require(parameters.sigma_census >= 0 && parameters.sigma_census <= 1, "sigma-census",
          parameters.sigma_census, "a share of bits from 0, which leaves the term out, to 1");
  require(parameters.sigma_gradient >= 0 && std::isfinite(parameters.sigma_gradient),
          "sigma-gradient", parameters.sigma_gradient,
          "a number of grey levels per pixel, at least 0, which leaves the term out");
  require(is_positive(parameters.truncation), "truncation", parameters.truncation,
          "a number of grey levels above 0");
  require(parameters.alpha >= 0 && std::isfinite(parameters.alpha), "alpha", parameters.alpha,
          "a number of at least 0");
  validate_diffusion(parameters);
  validate_bayes(parameters);
  validate_combination(parameters);
}

bool uses_edge_weights(const MethodParameters& parameters) {
  return parameters.aggregation == Aggregation::kBayes && parameters.edge_weight < 1;
}

}  // namespace vantage
