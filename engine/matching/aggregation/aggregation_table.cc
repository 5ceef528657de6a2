#include "engine/matching/aggregation/aggregation_table.h"

#include <array>

#include "engine/matching/aggregation/stage_bayes.h"
#include "engine/matching/aggregation/stage_diffusion.h"
#include "engine/matching/aggregation/stage_max_product.h"
#include "engine/matching/aggregation/stage_quadratic_bayes.h"
#include "engine/matching/aggregation/stage_smoothing.h"
#include "engine/matching/levels/energy_format.h"

namespace vantage {
namespace {

using Stages = std::vector<std::unique_ptr<scheduler::RowStage>>;

AggregationReach gaussian_reach(const MethodParameters& parameters) {
  return {4 * parameters.aggregation_sigma_px, "px"};
}

/// Reach of the iterations on the finest level.
AggregationReach iterations_reach(const MethodParameters& parameters) {
  return {static_cast<double>(at_level(parameters, 0).iterations), "iterations"};
}

Stages diffusion_stages(const MethodParameters& parameters, const AggregationPlace& place) {
  Stages stages;
  for (int i = 1; i <= parameters.iterations; ++i) {
    stages.push_back(make_diffusion_stage(parameters, place.geometry, place.height,
                                          weights_of_iteration(place.edges, i)));
  }
  return stages;
}

Stages local_stopping_stages(const MethodParameters& parameters, const AggregationPlace& place) {
  Stages stages;
  for (int i = 1; i <= parameters.iterations; ++i) {
    stages.push_back(
        make_local_stopping_stage(parameters, place.geometry, place.height,
                                  {.is_first = i == 1, .is_last = i == parameters.iterations},
                                  weights_of_iteration(place.edges, i)));
  }
  return stages;
}

Stages bayes_stages(const MethodParameters& parameters, const AggregationPlace& place) {
  return uses_fixed_energies(parameters)         ? make_max_product_stages(parameters, place)
         : parameters.prior == Prior::kQuadratic ? make_quadratic_bayes_stages(parameters, place)
                                                 : make_bayes_stages(parameters, place);
}

CellAggregation box() {
  return {.key = Aggregation::kBox,
          .name = "box",
          .description = "mean over a square window",
          .options = {"window", "border"},
          .has_windows = true,
          .reach =
              [](const MethodParameters& parameters) {
                return AggregationReach{static_cast<double>(parameters.window_px), "px"};
              },
          .make_stages =
              [](const MethodParameters& parameters, const AggregationPlace& place) {
                return make_box_mean_stages(place.geometry, place.height, parameters.window_px / 2);
              }};
}

CellAggregation local_stopping() {
  return {.key = Aggregation::kLocalStopping,
          .name = "local-stopping",
          .description = "diffusion that stops where certainty would fall",
          .options = {"iterations", "final-iterations", "lambda", "certainty", "sigma-measurement",
                      "edge-weight", "edge-contrast", "edge-diffusion"},
          .is_iterative = true,
          .reach = iterations_reach,
          .confidence =
              [](const MethodParameters& parameters) {
                return parameters.certainty == Certainty::kMargin ? ConfidenceMeasure::kMargin
                                                                  : ConfidenceMeasure::kEntropy;
              },
          .make_stages = local_stopping_stages};
}

CellAggregation bayes() {
  return {
      .key = Aggregation::kBayes,
      .name = "bayes",
      .description = "neighbours support similar disparities",
      .options = {"iterations", "final-iterations", "mu", "prior", "sigma-prior", "epsilon-prior",
                  "prior-growth", "prior-smoothing", "level-weight", "slant-penalty", "edge-weight",
                  "edge-contrast", "edge-diffusion", "sigma-measurement", "epsilon-measurement",
                  "candidate-blocks", "pruned-levels"},
      .natural_cost = MatchCost::kContaminated,
      .cells = CellMeaning::kLikelihood,
      .is_iterative = true,
      .reach = iterations_reach,
      .confidence = [](const MethodParameters&) { return ConfidenceMeasure::kProbability; },
      .make_stages = bayes_stages};
}

}  // namespace

std::span<const CellAggregation> aggregation_table() {
  static const std::array table = {
      CellAggregation{.key = Aggregation::kNone,
                      .name = "none",
                      .description = "each pixel alone",
                      .options = {}},
      box(),
      CellAggregation{.key = Aggregation::kGaussian,
                      .name = "gaussian",
                      .description = "mean weighted by a Gaussian",
                      .options = {"aggregation-sigma"},
                      .reach = gaussian_reach,
                      .make_stages =
                          [](const MethodParameters& parameters, const AggregationPlace& place) {
                            return make_gaussian_stages(place.geometry, place.height,
                                                        parameters.aggregation_sigma_px);
                          }},
      CellAggregation{.key = Aggregation::kBoxCascade,
                      .name = "box-cascade",
                      .description = "four square windows in turn, close to a Gaussian",
                      .options = {"aggregation-sigma"},
                      .reach = gaussian_reach,
                      .make_stages =
                          [](const MethodParameters& parameters, const AggregationPlace& place) {
                            return make_box_cascade_stages(place.geometry, place.height,
                                                           parameters.aggregation_sigma_px);
                          }},
      CellAggregation{.key = Aggregation::kDiffusion,
                      .name = "diffusion",
                      .description = "repeated mean with the four neighbours",
                      .options = {"iterations", "final-iterations", "lambda", "edge-weight",
                                  "edge-contrast", "edge-diffusion"},
                      .is_iterative = true,
                      .reach = iterations_reach,
                      .make_stages = diffusion_stages},
      CellAggregation{.key = Aggregation::kMembrane,
                      .name = "membrane",
                      .description = "diffusion with a pull towards the first costs",
                      .options = {"iterations", "final-iterations", "lambda", "beta", "edge-weight",
                                  "edge-contrast", "edge-diffusion"},
                      .is_iterative = true,
                      .coarser_use = CoarserUse::kStart,
                      .reach = iterations_reach,
                      .make_stages = diffusion_stages},
      local_stopping(),
      bayes(),
  };
  return table;
}

const CellAggregation& aggregation_of(Aggregation aggregation) {
  return *std::ranges::find(aggregation_table(), aggregation, &CellAggregation::key);
}

}  // namespace vantage
