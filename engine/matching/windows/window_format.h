#pragma once

#include "engine/matching/parameters/method_parameters.h"
#include "kernels/window_evidence/window_evidence.h"
#include "kernels/window_step/window_step.h"

namespace vantage {

/// Units of the cells of windows: the smallest steps in which the ceiling of the prior and the
/// evidence of four pixels fit bytes.
class WindowFormat {
 public:
  /// `parameters`: of the level, see at_level().
  explicit WindowFormat(const MethodParameters& parameters);

  [[nodiscard]] double nats_per_step() const { return 1 / steps_per_nat_; }
  /// Evidence of one pixel: the log-likelihood of a distance of its code above that of an outlier.
  [[nodiscard]] const kernels::ByteByDistance& evidence() const { return evidence_; }
  /// count: candidates of the level.
  [[nodiscard]] kernels::WindowPrior prior(int count) const;
  [[nodiscard]] int ceiling() const { return ceiling_; }

 private:
  double sigma_prior_;  ///< 0: an impulse, whose rises are infinite
  double steps_per_nat_;
  int ceiling_;
  kernels::ByteByDistance evidence_;
};

}  // namespace vantage
