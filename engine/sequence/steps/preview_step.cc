#include "engine/io/images/preview.h"
#include "engine/sequence/shots/depth_picture.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

/// Paints the reference's map in colours.
class PreviewStep final : public RunStep {
 public:
  explicit PreviewStep(const FrameTools& tools) : options_(tools.options), shots_(tools.shots) {}

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
    return wants(options_, slot, SequenceOutput::kPreview);
  }

  void run(FrameSlot& slot) override {
    const PreviewRange range =
        preview_range_of_frame(options_, shots_, slot.frame, slot.pair.details.disparities);
    slot.preview.pixels = colour_preview(slot.maps.of(options_.match.reference).disparity_px.view(),
                                         range.min_px, range.max_px);
  }

 private:
  const SequenceOptions& options_;
  const ShotTable* shots_;
};

StepBytes preview_bytes(const SequenceOptions& options, const PairShape& shape) {
  return {.of_frame = options.saves(SequenceOutput::kPreview) ? 3 * shape.pixels() : 0};
}

}  // namespace

StepEntry preview_step() {
  return {.name = "preview",
          .account = "pictures",
          .make = make_step<PreviewStep>,
          .planned_bytes = preview_bytes,
          .held_bytes = [](const FrameSlot& slot) { return held_bytes(slot.preview); }};
}

}  // namespace vantage
