#include "engine/sequence/frame_flicker.h"

#include <vector>

namespace vantage {

FlickerSums FrameFlicker::add(const FrameSlot& slot) {
  if (!options_.measure_flicker) {
    return {};
  }
  if (slot.frame != next_frame_ || slot.frame % options_.chunk_frames == 0) {
    meter_.restart();
  }
  next_frame_ = slot.frame + 1;
  std::vector<ViewOfFrame> views;
  for (std::size_t view = 0; view < options_.views.size(); ++view) {
    views.push_back({slot.view_poses[view], &slot.views[view].image});
  }
  return meter_.add(*slot.left, slot.maps.left.disparity_px.view(), views, execution_);
}

}  // namespace vantage
