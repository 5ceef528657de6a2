#include "engine/sequence/segment_writer.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "engine/error.h"
#include "engine/image/stereo_display.h"
#include "engine/io/video/writing/frame_conversion.h"
#include "engine/sequence/journal/pending_files.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/video_frames.h"

extern "C" {
#include <libavutil/frame.h>
}

namespace vantage {

/// One video. `last` is shown again for skipped frames.
struct SegmentWriter::Stream {
  const OutputStream* output = nullptr;
  std::shared_ptr<VideoWriter> writer;
  LibavFrame last;
  int leading_skipped = 0;  ///< frames before the segment's first good one
};

SegmentWriter::SegmentWriter(const SequenceOptions& options, const SequenceLayout& layout,
                             ImageExtent frame_size, int max_waiting)
    : options_(options), layout_(layout), frame_size_(frame_size), max_waiting_(max_waiting) {
  for (const OutputStream& output : layout.streams()) {
    if (output.as_video) {
      streams_.emplace_back().output = &output;
    }
  }
}

SegmentWriter::~SegmentWriter() = default;

void SegmentWriter::begin(FrameRange frames) {
  frames_ = frames;
  for (Stream& stream : streams_) {
    stream.writer.reset();
    stream.leading_skipped = 0;
  }
}

/// The stream's last picture.
void SegmentWriter::write(Stream& stream, int times) {
  try {
    if (!stream.writer) {
      stream.writer = std::make_shared<VideoWriter>(layout_.segment(*stream.output, frames_),
                                                    stream.last->width, stream.last->height,
                                                    encoding_of(options_, stream.output->output));
      const std::lock_guard lock(mutex_);
      std::erase_if(writers_, [](const auto& writer) { return writer.expired(); });
      writers_.push_back(stream.writer);
    }
    for (int i = 0; i < times; ++i) {
      stream.writer->add(another_reference(*stream.last));
      while (stream.writer->frames_waiting() > max_waiting_ && encode_some()) {
      }
    }
  } catch (const Error& error) {
    throw OutputError(error.what());
  }
}

bool SegmentWriter::encode_some() {
  std::vector<std::shared_ptr<VideoWriter>> writers;
  {
    const std::lock_guard lock(mutex_);
    for (const std::weak_ptr<VideoWriter>& writer : writers_) {
      if (auto one = writer.lock()) {
        writers.push_back(std::move(one));
      }
    }
  }
  return std::ranges::any_of(writers, [](const auto& writer) { return writer->encode_some(); });
}

void SegmentWriter::add(FrameSlot& slot) {
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    streams_[i].last = std::move(slot.video_frames[i]);
    write(streams_[i], 1 + std::exchange(streams_[i].leading_skipped, 0));
  }
}

void SegmentWriter::add_skipped() {
  for (Stream& stream : streams_) {
    if (stream.writer) {
      write(stream, 1);
    } else {
      ++stream.leading_skipped;
    }
  }
}

/// Has the size of good frames, because segments are joined.
Photograph SegmentWriter::black_picture(const OutputStream& output) const {
  const ImageExtent size =
      is_per_view(output.output)
          ? extent_of(options_.views[static_cast<std::size_t>(output.view)], frame_size_)
          : frame_size_;
  if (output.output == SequenceOutput::kDepthVideo) {
    Image<std::uint16_t> unknown(size.width_px, size.height_px);
    unknown.fill(0);
    return Photograph{std::move(unknown)};
  }
  Photograph black{Image<std::uint8_t>(size.width_px, size.height_px)};
  std::get<Image<std::uint8_t>>(black.pixels).fill(0);
  if (output.output != SequenceOutput::kStereo) {
    return black;
  }
  Photograph packed;
  show_stereo(black, black, options_.stereo_packing, packed);
  return packed;
}

std::vector<std::shared_ptr<VideoWriter>> SegmentWriter::end(FrameRange frames) {
  std::vector<std::shared_ptr<VideoWriter>> videos;
  // The streams have the same frames: all have pictures, or none has.
  if (!streams_.front().writer && streams_.front().leading_skipped == 0) {
    return videos;
  }
  for (Stream& stream : streams_) {
    if (!stream.writer) {
      const Photograph black = black_picture(*stream.output);
      const VideoEncoding encoding = encoding_of(options_, stream.output->output);
      stream.last = make_frame_conversion(encoding.coding, black.width(), black.height(),
                                          encoding.format.colours)(black);
      write(stream, std::exchange(stream.leading_skipped, 0));
    }
    try {
      stream.writer->end();
      if (frames != frames_) {
        stream.writer->rename(layout_.segment(*stream.output, frames));
      }
    } catch (const Error& error) {
      throw OutputError(error.what());
    }
    videos.push_back(std::move(stream.writer));
  }
  return videos;
}

}  // namespace vantage
