#include "engine/sequence/shots/depth_picture.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

bool wants_depth_picture(const FrameTools& tools, const FrameSlot& slot) {
  return wants(tools.options, slot, SequenceOutput::kDepthVideo);
}

/// The reference's map in grey, for the depth video.
void paint_depth_picture(const FrameTools& tools, FrameSlot& slot) {
  const MatchOptions& match = tools.options.match;
  const DisparityMap& map = slot.maps.of(match.reference).disparity_px;
  auto picture = take_image<std::uint16_t>(slot.depth, {map.width(), map.height(), 1});
  paint_depth(map.view(),
              depth_range_of(tools.options.depth_scale, match.disparities, tools.shots, slot.frame),
              picture);
  slot.depth.pixels = std::move(picture);
}

StepBytes depth_picture_bytes(const SequenceOptions& options, const PairShape& shape) {
  return {.of_frame = options.saves(SequenceOutput::kDepthVideo) ? 2 * shape.pixels() : 0};
}

}  // namespace

StepEntry depth_picture_step() {
  return {.name = "depth",
          .account = "pictures",
          .make = make_step<wants_depth_picture, paint_depth_picture>,
          .planned_bytes = depth_picture_bytes,
          .held_bytes = [](const FrameSlot& slot) { return held_bytes(slot.depth); }};
}

}  // namespace vantage
