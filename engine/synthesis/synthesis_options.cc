#include "engine/synthesis/synthesis_options.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/error.h"
#include "engine/with_opencv.h"

namespace vantage {

void SynthesisOptions::validate() const {
  if (holes == HoleFilling::kInpaint && !has_opencv()) {
    throw UsageError("holes is inpaint, expected another: this build is without OpenCV");
  }
  if (gamma && !(*gamma >= 0 && *gamma <= 1)) {
    throw UsageError(fmt::format("gamma is {}, expected 0..1", *gamma));
  }
  if (!(disparity_gradient_limit_px >= 0 && std::isfinite(disparity_gradient_limit_px))) {
    throw UsageError(fmt::format("disparity-gradient-limit is {}, expected a finite number ≥ 0",
                                 disparity_gradient_limit_px));
  }
}

}  // namespace vantage
