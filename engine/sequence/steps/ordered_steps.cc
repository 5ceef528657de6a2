// The steps that runs do themselves, because they are in the order of the frames.
#include <algorithm>

#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

StepBytes read_bytes(const SequenceOptions& options, const PairShape& shape) {
  (void)options;
  return {.of_run = static_cast<std::size_t>(shape.frames_kept) * shape.photograph_bytes()};
}

/// Delayed and reference frames of the video encoders.
StepBytes write_bytes(const SequenceOptions& options, const PairShape& shape) {
  std::size_t bytes = 0;
  const auto add_video = [&](ImageExtent extent) {
    constexpr std::size_t kFramesHeld = 64;
    bytes += PairShape::pixels_of(extent) * 3 / 2 * kFramesHeld + (std::size_t{8} << 20);
  };
  for (const SequenceOutput output : options.video) {
    if (!is_per_view(output)) {
      add_video(shape.source);
      continue;
    }
    for (const ViewPath& view : options.views) {
      add_video(extent_of(view, shape.source));
    }
  }
  return {.of_run = bytes};
}

}  // namespace

StepEntry read_step() {
  return {.name = "read",
          .account = "read",
          .kind = WorkKind::kReading,
          .phase = StepPhase::kRead,
          .planned_bytes = read_bytes};
}

StepEntry write_step() {
  return {.name = "write",
          .account = "write",
          .kind = WorkKind::kWriting,
          .phase = StepPhase::kWrite,
          .planned_bytes = write_bytes};
}

StepEntry deliver_step() {
  return {.name = "deliver",
          .account = "deliver",
          .kind = WorkKind::kWriting,
          .phase = StepPhase::kWrite};
}

}  // namespace vantage
