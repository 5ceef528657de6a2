#include "engine/sequence/steps/step_list.h"

#include <array>

namespace vantage {

std::span<const StepEntry> frame_steps() {
#define VANTAGE_CALL(step) step(),
  static const std::array steps = {VANTAGE_FRAME_STEPS(VANTAGE_CALL)};
#undef VANTAGE_CALL
  return steps;
}

}  // namespace vantage
