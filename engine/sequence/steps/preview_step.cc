#include "engine/io/images/preview.h"
#include "engine/sequence/shots/depth_picture.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

bool wants_preview(const FrameTools& tools, const FrameSlot& slot) {
  return wants(tools.options, slot, SequenceOutput::kPreview);
}

/// The reference's map in colours.
void paint_preview(const FrameTools& tools, FrameSlot& slot) {
  const PreviewRange range =
      preview_range_of_frame(tools.options, tools.shots, slot.frame, slot.pair.details.disparities);
  slot.preview.pixels = colour_preview(
      slot.maps.of(tools.options.match.reference).disparity_px.view(), range.min_px, range.max_px);
}

StepBytes preview_bytes(const SequenceOptions& options, const PairShape& shape) {
  return {.of_frame = options.saves(SequenceOutput::kPreview) ? 3 * shape.pixels() : 0};
}

}  // namespace

StepEntry preview_step() {
  return {.name = "preview",
          .account = "pictures",
          .make = make_step<wants_preview, paint_preview>,
          .planned_bytes = preview_bytes,
          .held_bytes = [](const FrameSlot& slot) { return held_bytes(slot.preview); }};
}

}  // namespace vantage
