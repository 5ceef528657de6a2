#include "engine/sequence/steps/frame_memory.h"

#include "engine/image/memory_use.h"

namespace vantage {

std::size_t held_bytes(const FrameSlot& slot) {
  std::size_t bytes = held_bytes(slot.pair.left) + held_bytes(slot.pair.right) +
                      held_bytes(slot.maps) + held_bytes(slot.posterior.mean_px()) +
                      held_bytes(slot.posterior.variance_px2()) +
                      held_bytes(slot.cyclopean.disparity_px) + held_bytes(slot.cyclopean.seen_by) +
                      held_bytes(slot.preview) + held_bytes(slot.stereo) + held_bytes(slot.depth) +
                      held_bytes(slot.encoded);
  for (const Photograph& photograph : slot.pair.more) {
    bytes += held_bytes(photograph);
  }
  for (const Photograph& photograph : slot.rectified) {
    bytes += held_bytes(photograph);
  }
  for (const Image<float>& map : slot.photograph_maps) {
    bytes += held_bytes(map);
  }
  for (const SynthesizedView& view : slot.views) {
    bytes += held_bytes(view.image) + held_bytes(view.holes) + held_bytes(view.sources);
  }
  return bytes;
}

}  // namespace vantage
