#include <fmt/format.h>

#include "engine/error.h"
#include "engine/image/content_hash.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

void require_size(const Photograph& photograph, std::string_view side, ImageExtent expected) {
  if (photograph.width() != expected.width_px || photograph.height() != expected.height_px) {
    throw Error(fmt::format("the {} image is {}x{}, expected {}x{} as at the start of the sequence",
                            side, photograph.width(), photograph.height(), expected.width_px,
                            expected.height_px));
  }
}

bool is_always_needed(const FrameTools& /*tools*/, const FrameSlot& /*slot*/) { return true; }

/// Makes the images of a frame, and finds its cameras.
void decode(const FrameTools& tools, FrameSlot& slot) {
  FramePair& pair = slot.pair;
  tools.pairs.decode(pair);
  slot.content = {content_hash(pair.left), content_hash(pair.right)};
  if (tools.pairs.is_stream() && tools.options.needs_shots()) {
    slot.thumbnail = make_thumbnail(pair.left);
  }
  if (tools.frame_size) {
    require_size(pair.left, "left", *tools.frame_size);
    require_size(pair.right, "right", *tools.frame_size);
    for (std::size_t k = 0; k < pair.more.size(); ++k) {
      require_size(pair.more[k], fmt::format("camera {}'s", k + 3), *tools.frame_size);
    }
  }
  slot.left = &pair.left;
  slot.right = &pair.right;
  if (!pair.details.calibration.empty()) {
    const ImageExtent size{pair.left.width(), pair.left.height()};
    require_size(pair.right, "right", size);
    slot.cameras = tools.cameras.of_pairs->of(pair.details, size);
  }
}

StepBytes decode_bytes(const SequenceOptions& options, const PairShape& shape) {
  const std::size_t more = options.baselines.empty() ? 0 : options.baselines.size() - 1;
  // Fetched and decoded; a packed frame holds both images once more.
  std::size_t photographs = 4 + 2 * more;
  std::size_t conversion = 0;
  if (shape.is_video) {
    photographs += 2 + more;                                      // decoder output, upper bound
    conversion = 2 * 3 * sizeof(std::uint16_t) * shape.pixels();  // luma and chroma in 16 bits
  }
  return {.of_frame = photographs * shape.photograph_bytes(), .of_work = conversion};
}

std::size_t decoded_bytes(const FrameSlot& slot) {
  std::size_t bytes = held_bytes(slot.pair.left) + held_bytes(slot.pair.right);
  for (const Photograph& photograph : slot.pair.more) {
    bytes += held_bytes(photograph);
  }
  return bytes;
}

}  // namespace

StepEntry decode_step() {
  return {.name = "decode",
          .account = "decode",
          .kind = WorkKind::kReading,
          .phase = StepPhase::kPrepare,
          .make = make_step<is_always_needed, decode>,
          .planned_bytes = decode_bytes,
          .held_bytes = decoded_bytes};
}

}  // namespace vantage
