#include "engine/sequence/steps/frame_slot.h"

#include "engine/sequence/steps/step_list.h"

namespace vantage {

void FrameSlot::begin_frame() {
  is_absent = false;
  stored = nullptr;
  cameras.reset();
  rows.reset();
  maps_are_read = false;
  match = {};
  deferred = {};
  shot.reset();
  may_be_cut = false;
  cut.reset();
  view_poses.clear();
  comfort.reset();
  disparities.reset();
  video_frames.clear();
  files.discard();  // left by an abandoned frame
  file_records.clear();
  times.clear();
}

std::size_t held_bytes(const FrameSlot& slot) {
  std::size_t bytes = 0;
  for (const StepEntry& step : frame_steps()) {
    bytes += step.held_bytes != nullptr ? step.held_bytes(slot) : 0;
  }
  return bytes;
}

}  // namespace vantage
