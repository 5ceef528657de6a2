#include "engine/rectification/rows/row_correction.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

bool has_right_map(const FrameTools& tools, const FrameSlot& slot) {
  (void)tools;
  return slot.rows && !slot.maps.right.disparity_px.empty();
}

/// The right map and image as they were given. All that needs them on the rows of the left image
/// has been made.
void bring_back(const FrameTools& tools, FrameSlot& slot) {
  bring_to_given_rows(*slot.rows, slot.maps.right, tools.execution);
  slot.right = tools.cameras.rectifier_of(slot) != nullptr ? &slot.rectified[1] : &slot.pair.right;
}

}  // namespace

StepEntry given_rows_step() {
  return {.name = "rows back", .account = "encode", .make = make_step<has_right_map, bring_back>};
}

}  // namespace vantage
