#include "engine/comfort/frame_comfort.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

/// The record of a stored frame has it.
bool needs_comfort(const FrameTools& tools, const FrameSlot& slot) {
  return tools.options.saves(SequenceOutput::kComfort) && slot.stored == nullptr;
}

/// Measures how comfortable a pair is to watch.
void measure_comfort_of(const FrameTools& tools, FrameSlot& slot) {
  const Side reference = tools.options.match.reference;
  slot.comfort = measure_comfort(*slot.left, *slot.right, slot.maps.of(reference), reference);
}

}  // namespace

StepEntry comfort_step() {
  return {.name = "comfort",
          .account = "comfort",
          .make = make_step<needs_comfort, measure_comfort_of>};
}

}  // namespace vantage
