#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/matching/options/method_parameters.h"
#include "kernels/cells/fixed_energy.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "kernels/fixed_energies/fixed_energies.h"

namespace vantage {

/// Whether Bayesian diffusion takes the largest term of the prior's sum, and energies in fixed
/// point are what its cells hold.
inline bool uses_fixed_energies(const MethodParameters& parameters) {
  return parameters.aggregation == Aggregation::kBayes &&
         parameters.prior_smoothing == PriorSmoothing::kMaximum;
}

/// The fixed point of energies on all levels of a map: steps as small as the largest sums have room
/// for, at least 1/kMostStepsPerNat.
class EnergyFormat {
 public:
  explicit EnergyFormat(const MethodParameters& parameters) {
    // In terms that are finite for every ε. From ε = ½ on contamination is more likely than any
    // offset: neighbours say nothing.
    const double epsilon = parameters.epsilon_prior;
    const double ceiling_nats = std::max(std::log1p(-epsilon) - std::log(epsilon), 0.0);
    // Of a star whose cells all are at the ceiling, its source, and a ceiling more that sums must
    // stay away from the end of the range.
    const double most_nats = (5 * parameters.mu + 1) * ceiling_nats + kMostSourceNats;
    constexpr double kRounding = 0.99;
    const double steps =
        std::min<double>(kMostStepsPerNat, kRounding * kernels::kMostEnergy / most_nats);
    steps_per_nat_ = static_cast<float>(steps);
    ceiling_ = static_cast<kernels::FixedEnergy>(std::lround(steps * ceiling_nats));
    // Without an iteration behind it a result is the map's own, ceiling or not.
    const double most_nats_of_result = parameters.final_iterations == 0 ? kUnseenNats : 0;
    result_range_ = static_cast<kernels::FixedEnergy>(std::max<long>(
        {ceiling_, kernels::kMostCompact + 1, std::lround(steps * most_nats_of_result)}));
  }

  [[nodiscard]] float steps_per_nat() const { return steps_per_nat_; }
  /// What the prior says of all offsets, ln((1 − εP)/εP): 1 − εP is what it says of none.
  [[nodiscard]] kernels::FixedEnergy ceiling() const { return ceiling_; }
  /// Of bytes that count steps of so many nats.
  [[nodiscard]] kernels::ByteSteps of_bytes(float nats) const {
    return kernels::ByteSteps(steps_per_nat_ * nats);
  }

  // What a level ends with is kept in bytes up to the ceiling, beyond which no iteration looks. The
  // last byte stands for the ceiling or a step more, never less.
  [[nodiscard]] kernels::ByteSteps of_result() const {
    constexpr float kHalfStep = 0.5F;
    return kernels::ByteSteps((static_cast<float>(result_range_) + kHalfStep) /
                              kernels::kMostCompact);
  }
  [[nodiscard]] kernels::FixedWeight result_bytes_per_step() const {
    return kernels::fixed_weight(static_cast<float>(kernels::kMostCompact) /
                                 static_cast<float>(result_range_));
  }

  /// k²/2σP², k from 1 to where it reaches the ceiling, below `count`.
  [[nodiscard]] std::vector<kernels::FixedEnergy> prior_rises(double sigma_prior, int count) const {
    std::vector<kernels::FixedEnergy> rises;
    for (int k = 1; k < count; ++k) {
      const double rise =
          std::nearbyint(steps_per_nat_ * (k / sigma_prior) * (k / sigma_prior) / 2);
      if (rise >= ceiling_) {
        break;
      }
      rises.push_back(static_cast<kernels::FixedEnergy>(rise));
    }
    return rises;
  }

 private:
  static constexpr double kMostStepsPerNat = 256;
  /// Likelihoods end there; bytes before.
  static constexpr double kMostSourceNats = 87.4;
  /// As far as bytes of probabilities reach, too.
  static constexpr double kUnseenNats = 22;

  float steps_per_nat_ = 0;
  kernels::FixedEnergy ceiling_ = 0;
  kernels::FixedEnergy result_range_ = 0;
};

}  // namespace vantage
