#include "engine/sequence/shots/depth_picture.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

/// Paints the reference's map in grey, for the depth video.
class DepthPictureStep final : public RunStep {
 public:
  explicit DepthPictureStep(const FrameTools& tools)
      : options_(tools.options), shots_(tools.shots) {}

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
    return wants(options_, slot, SequenceOutput::kDepthVideo);
  }

  void run(FrameSlot& slot) override {
    const DisparityMap& map = slot.maps.of(options_.match.reference).disparity_px;
    auto picture = take_image<std::uint16_t>(slot.depth, {map.width(), map.height(), 1});
    paint_depth(
        map.view(),
        depth_range_of(options_.depth_scale, options_.match.disparities, shots_, slot.frame),
        picture);
    slot.depth.pixels = std::move(picture);
  }

 private:
  const SequenceOptions& options_;
  const ShotTable* shots_;
};

StepBytes depth_picture_bytes(const SequenceOptions& options, const PairShape& shape) {
  return {.of_frame = options.saves(SequenceOutput::kDepthVideo) ? 2 * shape.pixels() : 0};
}

}  // namespace

StepEntry depth_picture_step() {
  return {.name = "depth",
          .account = "pictures",
          .make = make_step<DepthPictureStep>,
          .planned_bytes = depth_picture_bytes,
          .held_bytes = [](const FrameSlot& slot) { return held_bytes(slot.depth); }};
}

}  // namespace vantage
