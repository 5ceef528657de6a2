#include "engine/comfort/frame_comfort.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

/// Measures how comfortable a pair is to watch. The record of a stored frame has it.
class ComfortStep final : public RunStep {
 public:
  explicit ComfortStep(const FrameTools& tools)
      : is_saved_(tools.options.saves(SequenceOutput::kComfort)),
        reference_(tools.options.match.reference) {}

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
    return is_saved_ && slot.stored == nullptr && !slot.is_lead_in;
  }

  void run(FrameSlot& slot) override {
    slot.comfort = measure_comfort(*slot.left, *slot.right, slot.maps.of(reference_), reference_);
  }

 private:
  bool is_saved_;
  Side reference_;
};

}  // namespace

StepEntry comfort_step() {
  return {.name = "comfort", .account = "comfort", .make = make_step<ComfortStep>};
}

}  // namespace vantage
