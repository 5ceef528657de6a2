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

/// Makes the images of a frame, and finds its cameras.
class DecodeStep final : public RunStep {
 public:
  explicit DecodeStep(const FrameTools& tools)
      : pairs_(tools.pairs),
        frame_size_(tools.frame_size),
        cameras_of_pairs_(tools.cameras.of_pairs),
        needs_thumbnails_(tools.pairs.is_stream() && tools.options.needs_shots()) {}

  [[nodiscard]] bool is_needed(const FrameSlot&) const override { return true; }

  void run(FrameSlot& slot) override {
    FramePair& pair = slot.pair;
    pairs_.decode(pair);
    slot.content = {content_hash(pair.left), content_hash(pair.right)};
    if (needs_thumbnails_) {
      slot.thumbnail = make_thumbnail(pair.left);
    }
    if (frame_size_) {
      require_size(pair.left, "left", *frame_size_);
      require_size(pair.right, "right", *frame_size_);
      for (std::size_t k = 0; k < pair.more.size(); ++k) {
        require_size(pair.more[k], fmt::format("camera {}'s", k + 3), *frame_size_);
      }
    }
    slot.left = &pair.left;
    slot.right = &pair.right;
    if (!pair.details.calibration.empty()) {
      const ImageExtent size{pair.left.width(), pair.left.height()};
      require_size(pair.right, "right", size);
      slot.cameras = cameras_of_pairs_->of(pair.details, size);
    }
  }

 private:
  const PairSource& pairs_;
  std::optional<ImageExtent> frame_size_;
  PairCameras* cameras_of_pairs_;
  bool needs_thumbnails_;
};

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
          .make = make_step<DecodeStep>,
          .planned_bytes = decode_bytes,
          .held_bytes = decoded_bytes};
}

}  // namespace vantage
