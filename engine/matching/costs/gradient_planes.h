#pragma once

#include <array>
#include <cstddef>

#include "engine/matching/costs/cost_planes.h"
#include "kernels/evidence/gradient_norm.h"

namespace vantage {

/// The norm of gradients and of their differences that `parameters` ask for.
kernels::EvidenceNorm evidence_norm(const MethodParameters& parameters);

/// Gradients in the form that the evidence (5.5) uses.
class GradientPlanes final : public CostPlanes {
 public:
  ChannelPlanes<float, 3> gradients;  ///< α·gx, α·gy, |g|/2

  void prepare(const PlaneSource& source, const MethodParameters& parameters) override;
  [[nodiscard]] std::size_t held_bytes() const override {
    return held_bytes_of(gradients) + held_bytes_of(intensities_) +
           held_bytes_of(smooth_intensities_);
  }

 private:
  FilterIntensities intensities_;
  FilterIntensities smooth_intensities_;
};

}  // namespace vantage
