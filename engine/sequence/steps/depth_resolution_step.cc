#include "engine/sequence/steps/step_list.h"
#include "engine/view_geometry/depth_resolution.h"

namespace vantage {
namespace {

/// The record of a stored frame has them.
bool needs_disparities(const FrameTools& tools, const FrameSlot& slot) {
  return tools.options.saves(SequenceOutput::kDepthResolution) && slot.stored == nullptr;
}

/// Notes the disparities of a frame and the scale of its depths, for the report on depth
/// resolution.
void note_disparities(const FrameTools& tools, FrameSlot& slot) {
  const DisparityMap& map = slot.maps.of(tools.options.match.reference).disparity_px;
  if (const auto found = disparity_quantiles(map.view())) {
    slot.disparities = {*found, tools.cameras.map_camera_of(slot)->scale};
  }
}

}  // namespace

StepEntry depth_resolution_step() {
  return {.name = "depth",
          .account = "pictures",
          .make = make_step<needs_disparities, note_disparities>};
}

}  // namespace vantage
