#include <deque>

#include "engine/error.h"
#include "engine/io/video/stated_format.h"
#include "engine/io/video/writing/frame_conversion.h"
#include "engine/object_pool.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/frame_pictures.h"
#include "engine/sequence/steps/step_list.h"
#include "engine/sequence/steps/video_frames.h"

namespace vantage {
namespace {

/// Converts the pictures of the videos to what their encoders take.
class VideoFramesStep final : public RunStep {
 public:
  explicit VideoFramesStep(const FrameTools& tools) : tools_(tools) {
    for (const OutputStream& stream : tools.layout.streams()) {
      if (stream.as_video) {
        videos_.emplace_back(stream, encoding_of(tools.options, stream.output));
      }
    }
  }

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
    (void)slot;
    return tools_.writes_files && !videos_.empty();
  }

  void run(FrameSlot& slot) override {
    for (Video& video : videos_) {
      Photograph mask;
      const Photograph* picture = stored_picture(slot, video.stream);
      if (picture == nullptr) {
        mask.pixels = mask_of(slot, video.stream, tools_.options.match.reference).copy();
        picture = &mask;
      }
      const auto conversion =
          video.conversions.borrow(video.encoding, picture->width(), picture->height());
      try {
        slot.video_frames.push_back(conversion->convert(*picture));
      } catch (const Error& error) {
        throw OutputError(error.what());
      }
    }
  }

 private:
  struct Conversion {
    FrameConversion convert;
    Conversion(const VideoEncoding& encoding, int width, int height)
        : convert(make_frame_conversion(encoding.coding, width, height, encoding.format.colours)) {}
  };
  struct Video {
    Video(const OutputStream& of_stream, const VideoEncoding& of_encoding)
        : stream(of_stream), encoding(of_encoding) {}
    const OutputStream& stream;
    VideoEncoding encoding;
    ObjectPool<Conversion> conversions;  // one per concurrent conversion
  };

  const FrameTools tools_;
  std::deque<Video> videos_;  // they cannot be moved
};

/// Frames in flight, those that wait, as SegmentWriter limits them, and those in encoders, of which
/// two are open, and more where many threads make frames faster than these encode.
StepBytes video_bytes(const SequenceOptions& options, const PairShape& shape) {
  constexpr std::size_t kEncoderFrames =
      14;  // that it delays and refers to, with its notes on them
  StepBytes bytes;
  const auto add_video = [&](SequenceOutput output, ImageExtent extent) {
    const VideoCodingTraits& coding = traits_of(encoding_of(options, output).coding);
    const std::size_t frame = PairShape::pixels_of(extent) * (coding.bits > 8 ? 4 : 2) * 3 / 4;
    bytes.of_frame += frame;
    bytes.of_work += (max_frames_waiting(1) - max_frames_waiting(0) + kEncoderFrames / 5) * frame;
    bytes.of_run += (max_frames_waiting(0) + 2 * kEncoderFrames) * frame + (std::size_t{8} << 20);
  };
  for (const SequenceOutput output : options.video) {
    if (!is_per_view(output)) {
      add_video(output, shape.source);
      continue;
    }
    for (const ViewPath& view : options.views) {
      add_video(output, extent_of(view, shape.source));
    }
  }
  return bytes;
}

std::size_t held_of_video_frames(const FrameSlot& slot) {
  std::size_t bytes = 0;
  for (const LibavFrame& frame : slot.video_frames) {
    bytes += frame == nullptr ? 0 : bytes_of(*frame);
  }
  return bytes;
}

}  // namespace

VideoEncoding encoding_of(const SequenceOptions& options, SequenceOutput output) {
  const FilmFormat format = film_format_of(output, options.film);
  return {
      options.frame_rate, options.crf,
      output == SequenceOutput::kDepthVideo ? options.depth_coding : colour_coding(format.colours),
      format};
}

StepEntry video_frames_step() {
  return {.name = "video frames",
          .account = "write",
          .kind = WorkKind::kWriting,
          .make = make_step<VideoFramesStep>,
          .planned_bytes = video_bytes,
          .held_bytes = held_of_video_frames};
}

}  // namespace vantage
