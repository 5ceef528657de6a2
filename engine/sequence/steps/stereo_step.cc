#include "engine/image/stereo_display.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

bool wants_stereo(const FrameTools& tools, const FrameSlot& slot) {
  return wants(tools.options, slot, SequenceOutput::kStereo);
}

/// Packs two views, or photographs, in one picture.
void pack_stereo(const FrameTools& tools, FrameSlot& slot) {
  std::size_t next_view = tools.options.views.size();
  const auto picture_at = [&](double view_x) {
    const Photograph* photograph = slot.photograph_at(view_x);
    return photograph != nullptr ? photograph : &slot.views[next_view++].image;
  };
  const Photograph* left = picture_at(tools.options.stereo_views_x[0]);
  const Photograph* right = picture_at(tools.options.stereo_views_x[1]);
  show_stereo(*left, *right, tools.options.stereo_packing, slot.stereo);
}

StepBytes stereo_bytes(const SequenceOptions& options, const PairShape& shape) {
  return {.of_frame = options.saves(SequenceOutput::kStereo) ? 2 * shape.photograph_bytes() : 0};
}

}  // namespace

StepEntry stereo_step() {
  return {.name = "stereo",
          .account = "pictures",
          .make = make_step<wants_stereo, pack_stereo>,
          .planned_bytes = stereo_bytes,
          .held_bytes = [](const FrameSlot& slot) { return held_bytes(slot.stereo); }};
}

}  // namespace vantage
