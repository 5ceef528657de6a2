#pragma once

#include <array>
#include <cstddef>

#include "engine/matching/costs/cost_planes.h"

namespace vantage {

/// Gradients in the form that the evidence (5.5) uses.
class GradientPlanes final : public CostPlanes {
 public:
  ChannelPlanes<float, 3> gradients;  ///< α·gx, α·gy, |g|/2

  void prepare(const PlaneSource& source, const MethodParameters& parameters) override;
  [[nodiscard]] std::size_t held_bytes() const override {
    return held_bytes_of(gradients) + held_bytes_of(levels_) + held_bytes_of(smooth_levels_);
  }

 private:
  FilterLevels levels_;
  FilterLevels smooth_levels_;
};

}  // namespace vantage
