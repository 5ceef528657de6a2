#include "engine/matching/parameters/method_parameters.h"

#include <cmath>

namespace vantage {

MethodParameters at_level(const MethodParameters& parameters, int level) {
  MethodParameters result = parameters;
  if (level == 0 && parameters.levels > 1) {
    result.iterations = parameters.final_iterations;
  }
  result.sigma_prior *= std::pow(parameters.prior_growth, level);
  result.sigma_prior *= steps_per_px(parameters);
  return result;
}

double disparity_resolution_px(const MethodParameters& parameters) {
  return parameters.subpixel == Subpixel::kNone ? 1 : 0.1;
}

int steps_per_px(const MethodParameters& parameters) {
  return static_cast<int>(std::lround(1 / parameters.candidate_step_px));
}

bool uses_edge_weights(const MethodParameters& parameters) {
  switch (parameters.aggregation) {
    case Aggregation::kDiffusion:
    case Aggregation::kMembrane:
    case Aggregation::kLocalStopping:
    case Aggregation::kBayes:
      return parameters.edge_weight < 1;
    default:
      return false;
  }
}

}  // namespace vantage
