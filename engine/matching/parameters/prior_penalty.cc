#include "engine/matching/parameters/prior_penalty.h"

#include <cmath>

namespace vantage {

double prior_penalty(const MethodParameters& parameters, double offset_px) {
  const double epsilon = parameters.epsilon_prior;
  const double deviations = offset_px / parameters.sigma_prior;
  const double quadratic = deviations * deviations / 2;
  switch (parameters.prior) {
    case Prior::kContaminatedGaussian:
      return -std::log((1 - epsilon) * std::exp(-quadratic) + epsilon);
    case Prior::kImpulse:
      return offset_px == 0 ? 0 : -std::log(epsilon);
    case Prior::kQuadratic:
      return quadratic;
  }
  return quadratic;
}

}  // namespace vantage
