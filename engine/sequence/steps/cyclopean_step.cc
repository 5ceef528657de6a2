#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

bool needs_cyclopean_map(const FrameTools& tools, const FrameSlot& slot) {
  return tools.options.saves_cyclopean() && slot.shot != nullptr;
}

void make_map_of_middle(const FrameTools& tools, FrameSlot& slot) {
  make_cyclopean_map(slot.maps.left, tools.execution, slot.cyclopean);
}

StepBytes cyclopean_bytes(const SequenceOptions& options, const PairShape& shape) {
  return {.of_frame = options.saves_cyclopean() ? shape.pixels() * (sizeof(float) + 1) : 0};
}

std::size_t held_of_cyclopean(const FrameSlot& slot) {
  return held_bytes(slot.cyclopean.disparity_px) + held_bytes(slot.cyclopean.seen_by);
}

}  // namespace

StepEntry cyclopean_step() {
  return {.name = "cyclopean map",
          .account = "match",
          .make = make_step<needs_cyclopean_map, make_map_of_middle>,
          .planned_bytes = cyclopean_bytes,
          .held_bytes = held_of_cyclopean};
}

}  // namespace vantage
