#include "engine/image/stereo_display.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

/// Packs two views, or photographs, in one picture.
class StereoStep final : public RunStep {
 public:
  explicit StereoStep(const FrameTools& tools) : options_(tools.options) {}

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
    return wants(options_, slot, SequenceOutput::kStereo);
  }

  void run(FrameSlot& slot) override {
    std::size_t next_view = options_.views.size();
    const auto picture_at = [&](double view_x) {
      const Photograph* photograph = slot.photograph_at(view_x);
      return photograph != nullptr ? photograph : &slot.views[next_view++].image;
    };
    const Photograph* left = picture_at(options_.stereo_views_x[0]);
    const Photograph* right = picture_at(options_.stereo_views_x[1]);
    show_stereo(*left, *right, options_.stereo_packing, slot.stereo);
  }

 private:
  const SequenceOptions& options_;
};

StepBytes stereo_bytes(const SequenceOptions& options, const PairShape& shape) {
  return {.of_frame = options.saves(SequenceOutput::kStereo) ? 2 * shape.photograph_bytes() : 0};
}

}  // namespace

StepEntry stereo_step() {
  return {.name = "stereo",
          .account = "pictures",
          .make = make_step<StereoStep>,
          .planned_bytes = stereo_bytes,
          .held_bytes = [](const FrameSlot& slot) { return held_bytes(slot.stereo); }};
}

}  // namespace vantage
