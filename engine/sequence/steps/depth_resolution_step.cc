#include "engine/sequence/steps/step_list.h"
#include "engine/view_geometry/depth_resolution.h"

namespace vantage {
namespace {

/// Notes the disparities of a frame and the scale of its depths, for the report on depth
/// resolution. The record of a stored frame has them.
class DepthResolutionStep final : public RunStep {
 public:
  explicit DepthResolutionStep(const FrameTools& tools)
      : is_saved_(tools.options.saves(SequenceOutput::kDepthResolution)),
        reference_(tools.options.match.reference),
        cameras_(tools.cameras) {}

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
    return is_saved_ && slot.stored == nullptr && !slot.is_lead_in;
  }

  void run(FrameSlot& slot) override {
    if (const auto found = disparity_quantiles(slot.maps.of(reference_).disparity_px.view())) {
      slot.disparities = {*found, cameras_.map_camera_of(slot)->scale};
    }
  }

 private:
  bool is_saved_;
  Side reference_;
  FrameCameras cameras_;
};

}  // namespace

StepEntry depth_resolution_step() {
  return {.name = "depth", .account = "pictures", .make = make_step<DepthResolutionStep>};
}

}  // namespace vantage
