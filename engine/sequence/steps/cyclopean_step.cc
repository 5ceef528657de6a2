#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

class CyclopeanStep final : public RunStep {
 public:
  explicit CyclopeanStep(const FrameTools& tools)
      : is_saved_(tools.options.saves_cyclopean()), execution_(tools.execution) {}

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
    return is_saved_ && slot.shot != nullptr && !slot.is_lead_in;
  }

  void run(FrameSlot& slot) override {
    make_cyclopean_map(slot.maps.left, execution_, slot.cyclopean);
  }

 private:
  bool is_saved_;
  Execution& execution_;
};

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
          .make = make_step<CyclopeanStep>,
          .planned_bytes = cyclopean_bytes,
          .held_bytes = held_of_cyclopean};
}

}  // namespace vantage
