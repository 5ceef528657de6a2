#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

bool needs_rectification(const FrameTools& tools, const FrameSlot& slot) {
  return tools.options.unrectified != UnrectifiedSearch::kOnPhotographs &&
         tools.cameras.rectifier_of(slot) != nullptr;
}

void rectify(const FrameTools& tools, FrameSlot& slot) {
  const Rectifier& rectifier = *tools.cameras.rectifier_of(slot);
  rectifier.apply(slot.pair.left, Side::kLeft, slot.rectified[0], tools.execution);
  rectifier.apply(slot.pair.right, Side::kRight, slot.rectified[1], tools.execution);
  slot.left = &slot.rectified[0];
  slot.right = &slot.rectified[1];
}

StepBytes rectify_bytes(const SequenceOptions& options, const PairShape& shape) {
  (void)options;
  if (!shape.is_rectified_here) {
    return {};
  }
  // Positions in the photographs.
  return {.of_frame = 2 * (shape.photograph_bytes() + shape.pixels()),
          .of_run = static_cast<std::size_t>(shape.cameras_kept) * 2 * 2 * sizeof(float) *
                    shape.pixels()};
}

std::size_t rectified_bytes(const FrameSlot& slot) {
  return held_bytes(slot.rectified[0]) + held_bytes(slot.rectified[1]);
}

}  // namespace

StepEntry rectify_step() {
  return {.name = "rectify",
          .account = "rectify",
          .phase = StepPhase::kPrepare,
          .make = make_step<needs_rectification, rectify>,
          .planned_bytes = rectify_bytes,
          .held_bytes = rectified_bytes};
}

}  // namespace vantage
