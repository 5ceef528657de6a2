#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

class RectifyStep final : public RunStep {
 public:
  explicit RectifyStep(const FrameTools& tools)
      : cameras_(tools.cameras),
        keeps_photographs_(tools.options.unrectified == UnrectifiedSearch::kOnPhotographs),
        execution_(tools.execution) {}

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
    return !keeps_photographs_ && cameras_.rectifier_of(slot) != nullptr;
  }

  void run(FrameSlot& slot) override {
    const Rectifier& rectifier = *cameras_.rectifier_of(slot);
    rectifier.apply(slot.pair.left, Side::kLeft, slot.rectified[0], execution_);
    rectifier.apply(slot.pair.right, Side::kRight, slot.rectified[1], execution_);
    slot.left = &slot.rectified[0];
    slot.right = &slot.rectified[1];
  }

 private:
  FrameCameras cameras_;
  bool keeps_photographs_;
  Execution& execution_;
};

StepBytes rectify_bytes(const SequenceOptions& options, const PairShape& shape) {
  (void)options;
  if (!shape.is_rectified_here) {
    return {};
  }
  // Positions in the photographs.
  return {.of_frame = 2 * shape.photograph_bytes(),
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
          .make = make_step<RectifyStep>,
          .planned_bytes = rectify_bytes,
          .held_bytes = rectified_bytes};
}

}  // namespace vantage
