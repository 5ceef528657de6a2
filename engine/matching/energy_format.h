#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/matching/method_parameters.h"
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
    const double epsilon = parameters.epsilon_prior;
    const double ceiling_nats = std::max(std::log((1 - epsilon) / epsilon), kLeastCeilingNats);
    // Of a star whose cells all are at the ceiling, its source, and a ceiling more that sums must
    // stay away from the end of the range.
    const double most_nats = (5 * parameters.mu + 1) * ceiling_nats + kMostSourceNats;
    constexpr double kRounding = 0.99;
    const double steps =
        std::min<double>(kMostStepsPerNat, kRounding * kernels::kMostEnergy / most_nats);
    steps_per_nat_ = static_cast<float>(steps);
    ceiling_ = static_cast<kernels::FixedEnergy>(std::lround(steps * ceiling_nats));
  }

  [[nodiscard]] float steps_per_nat() const { return steps_per_nat_; }
  /// What the prior says of all offsets, −ln εP.
  [[nodiscard]] kernels::FixedEnergy ceiling() const { return ceiling_; }
  /// Of bytes that count steps of so many nats.
  [[nodiscard]] kernels::ByteSteps of_bytes(float nats) const {
    return kernels::ByteSteps(steps_per_nat_ * nats);
  }

  // What a level ends with is kept in bytes up to the ceiling, beyond which nothing is looked at.
  // The last byte stands for the ceiling or a step more, never less.
  [[nodiscard]] kernels::ByteSteps of_result() const {
    constexpr float kHalfStep = 0.5F;
    return kernels::ByteSteps((static_cast<float>(ceiling_) + kHalfStep) / kernels::kMostCompact);
  }
  [[nodiscard]] kernels::FixedWeight result_bytes_per_step() const {
    return kernels::fixed_weight(static_cast<float>(kernels::kMostCompact) /
                                 static_cast<float>(ceiling_));
  }

  /// k²/2σP², k from 1 to where it reaches the ceiling, below `count`.
  [[nodiscard]] std::vector<kernels::FixedEnergy> prior_rises(double sigma_prior, int count) const {
    std::vector<kernels::FixedEnergy> rises;
    for (int k = 1; k < count; ++k) {
      const double rise = steps_per_nat_ * (k / sigma_prior) * (k / sigma_prior) / 2;
      if (rise >= ceiling_) {
        break;
      }
      rises.push_back(static_cast<kernels::FixedEnergy>(std::lround(rise)));
    }
    return rises;
  }

 private:
  static constexpr double kMostStepsPerNat = 256;
  /// εP near 1 leaves no prior; results still need a range.
  static constexpr double kLeastCeilingNats = 1;
  /// Compact energies end there.
  static constexpr double kMostSourceNats = kernels::kMostCompact * kernels::kEnergyStep + 0.1;

  float steps_per_nat_ = 0;
  kernels::FixedEnergy ceiling_ = 0;
};

}  // namespace vantage
