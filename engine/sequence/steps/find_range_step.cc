#include "engine/matching/range_estimation.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

bool has_no_range(const FrameTools& tools, const FrameSlot& slot) {
  return tools.options.search_scope == SearchScope::kPair && !slot.pair.details.disparities;
}

/// As if the list had it.
void find_own_range(const FrameTools& tools, FrameSlot& slot) {
  slot.pair.details.disparities =
      estimate_disparity_range(*slot.left, *slot.right, tools.execution);
}

}  // namespace

StepEntry find_range_step() {
  return {.name = "range",
          .account = "match",
          .phase = StepPhase::kPrepare,
          .make = make_step<has_no_range, find_own_range>};
}

}  // namespace vantage
