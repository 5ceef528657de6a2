#include "engine/sequence/steps/frame_needs.h"

#include <algorithm>
#include <variant>

namespace vantage {

MatchRequest match_request(const SequenceOptions& options) {
  const bool right_is_primary = options.match.reference == Side::kRight;
  const bool both = !options.views.empty() || options.saves(SequenceOutput::kStereo) ||
                    options.saves(SequenceOutput::kRightDisparity) ||
                    options.saves(SequenceOutput::kRightUnmatched) ||
                    options.temporal.weight > 0;  // both are stored for the next frame
  return {.left = !right_is_primary || both || options.saves_cyclopean(),
          .right = right_is_primary || both,
          .probability = options.saves(SequenceOutput::kConfidence) ||
                         (options.saves_points() && options.cloud.reads_confidence())};
}

bool videos_show_views(const SequenceOptions& options) {
  return std::ranges::any_of(options.video, [](SequenceOutput output) {
    return is_per_view(output) || output == SequenceOutput::kStereo;
  });
}

bool needs_views(const SequenceOptions& options, const FrameSlot& slot) {
  return slot.stored == nullptr || videos_show_views(options);
}

bool views_show_photographs(const SequenceOptions& options) {
  return options.synthesis.warp == WarpColour::kOnePass &&
         (!options.views.empty() || options.saves(SequenceOutput::kStereo));
}

ImageExtent extent_of(const ViewPath& view, ImageExtent images) {
  const auto* camera = std::get_if<PosedCamera>(&view.keys.front().pose);
  return camera != nullptr && camera->width_px > 0
             ? ImageExtent{camera->width_px, camera->height_px}
             : images;
}

bool wants(const SequenceOptions& options, const FrameSlot& slot, SequenceOutput output) {
  return slot.stored == nullptr ? options.saves(output) : options.saves_as_video(output);
}

}  // namespace vantage
