#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/matching/parameters/method_parameters.h"
#include "kernels/cells/fixed_energy.h"
#include "kernels/compact_likelihoods/compact_likelihoods.h"
#include "kernels/fixed_energies/fixed_energies.h"

namespace vantage {

/// Whether Bayesian diffusion uses the largest term of the prior's sum, with fixed-point energies
/// as cells. Energies of the quadratic prior have no limit.
inline bool uses_fixed_energies(const MethodParameters& parameters) {
  return parameters.aggregation == Aggregation::kBayes &&
         parameters.prior_smoothing == PriorSmoothing::kMaximum &&
         parameters.prior != Prior::kQuadratic;
}

/// Fixed-point format of energies on all levels of a map: the smallest steps that leave room for
/// the largest sums, but at least 1/kMaxStepsPerNat.
class EnergyFormat {
 public:
  explicit EnergyFormat(const MethodParameters& parameters) {
    // Terms finite for every ε. From ε = ½ on contamination is more likely than any offset, and
    // neighbours carry no information.
    const double epsilon = parameters.epsilon_prior;
    const double ceiling_nats = std::max(std::log1p(-epsilon) - std::log(epsilon), 0.0);
    // Worst case: five neighbours at the ceiling plus the source, with one ceiling of headroom
    // against overflow.
    const double max_nats = (5 * parameters.mu + 1) * ceiling_nats + kMaxSourceNats;
    constexpr double kRounding = 0.99;
    const double steps =
        std::min<double>(kMaxStepsPerNat, kRounding * kernels::kMaxEnergy / max_nats);
    steps_per_nat_ = static_cast<float>(steps);
    ceiling_ = static_cast<kernels::FixedEnergy>(std::lround(steps * ceiling_nats));
    // Without final iterations the coarse result is the final map, which must not be cut at the
    // ceiling.
    const double max_nats_of_result = parameters.final_iterations == 0 ? kUnseenNats : 0;
    result_range_ = static_cast<kernels::FixedEnergy>(std::max<long>(
        {ceiling_, kernels::kMaxCompact + 1, std::lround(steps * max_nats_of_result)}));
  }

  [[nodiscard]] float steps_per_nat() const { return steps_per_nat_; }
  /// Energy of the prior's floor, the same for all offsets: ln((1 − εP)/εP), relative to 1 − εP for
  /// no offset.
  [[nodiscard]] kernels::FixedEnergy ceiling() const { return ceiling_; }
  /// Bytes in steps of `nats`.
  [[nodiscard]] kernels::ByteSteps of_bytes(float nats) const {
    return kernels::ByteSteps(steps_per_nat_ * nats);
  }

  // A level's result is stored in bytes up to the ceiling; iterations do not read beyond it. The
  // last byte stands for the ceiling or up to one step more, never less.
  [[nodiscard]] kernels::ByteSteps of_result() const {
    constexpr float kHalfStep = 0.5F;
    return kernels::ByteSteps((static_cast<float>(result_range_) + kHalfStep) /
                              kernels::kMaxCompact);
  }
  [[nodiscard]] kernels::FixedWeight result_bytes_per_step() const {
    return kernels::fixed_weight(static_cast<float>(kernels::kMaxCompact) /
                                 static_cast<float>(result_range_));
  }

  /// k²/2σP² for k from 1 until the ceiling, k < `count`.
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
  static constexpr double kMaxStepsPerNat = 256;
  /// Largest energy of a float likelihood; that of bytes is smaller.
  static constexpr double kMaxSourceNats = 87.4;
  /// Also the range of probabilities stored in bytes.
  static constexpr double kUnseenNats = 22;

  float steps_per_nat_ = 0;
  kernels::FixedEnergy ceiling_ = 0;
  kernels::FixedEnergy result_range_ = 0;
};

}  // namespace vantage
