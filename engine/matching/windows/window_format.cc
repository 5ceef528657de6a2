#include "engine/matching/windows/window_format.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vantage {
namespace {

constexpr int kMaxCell = 255;

double ceiling_nats(const MethodParameters& parameters) {
  const double epsilon = parameters.epsilon_prior;
  return std::max(std::log1p(-epsilon) - std::log(epsilon), 0.0);
}

}  // namespace

WindowFormat::WindowFormat(const MethodParameters& parameters)
    : sigma_prior_(parameters.prior == Prior::kImpulse ? 0 : parameters.sigma_prior) {
  constexpr double kMaxStepsPerNat = 16;
  const double outlier_nats = -std::log(parameters.epsilon_measurement);
  const double ceiling = ceiling_nats(parameters);
  steps_per_nat_ = std::min({kMaxStepsPerNat, kMaxCell / std::max(ceiling, 1e-3),
                             kernels::kMaxPixelEvidence / std::max(outlier_nats, 1e-3)});
  ceiling_ = static_cast<int>(std::lround(steps_per_nat_ * ceiling));
  const int thresholds = parameters.census_thresholds;
  const int distances = kernels::ray_census_distances(thresholds);
  for (int distance = 0; distance < distances; ++distance) {
    const double deviations = distance / (parameters.sigma_measurement * thresholds);
    const double epsilon = parameters.epsilon_measurement;
    const double nats =
        outlier_nats + std::log((1 - epsilon) * std::exp(-deviations * deviations / 2) + epsilon);
    evidence_.steps[static_cast<std::size_t>(distance)] =
        static_cast<std::uint8_t>(std::lround(steps_per_nat_ * std::max(nats, 0.0)));
  }
  evidence_.find_last(distances);
}

kernels::WindowPrior WindowFormat::prior(int count) const {
  kernels::WindowPrior prior;
  prior.ceiling = static_cast<std::uint16_t>(ceiling_ * kernels::kWindowTotalUnits);
  for (int k = 1; k <= kernels::kMaxWindowPriorRadius; ++k) {
    const double deviations = k / sigma_prior_;
    const double rise =
        std::nearbyint(steps_per_nat_ * kernels::kWindowTotalUnits * deviations * deviations / 2);
    if (rise >= prior.ceiling) {
      break;
    }
    prior.rises[static_cast<std::size_t>(k - 1)] = static_cast<std::uint16_t>(rise);
    prior.radius = k;
  }
  if (count < kernels::kWindowCandidates) {
    prior.lanes = (kernels::WindowCells{1} << (8 * count)) - 1;
  }
  return prior;
}

}  // namespace vantage
