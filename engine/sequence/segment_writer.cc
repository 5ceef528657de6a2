#include "engine/sequence/segment_writer.h"

#include <malloc.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

#include "engine/error.h"
#include "engine/image/stereo_display.h"
#include "engine/io/video/stated_format.h"
#include "engine/sequence/journal/pending_files.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/frame_pictures.h"

namespace vantage {

/// One video. `last` is shown again for skipped frames.
struct SegmentWriter::Stream {
  const OutputStream* output = nullptr;
  std::unique_ptr<VideoWriter> writer;
  Photograph last;
  int leading_skipped = 0;  ///< frames before the segment's first good one
};

namespace {

/// Encoders use much memory on whichever thread they run, and the allocator keeps freed memory per
/// thread: without this a run grows from segment to segment for a while.
void return_free_memory() {
#ifdef __GLIBC__
  (void)::malloc_trim(0);
#endif
}

/// Videos need at least two pixels a side: smaller pictures are repeated.
Photograph at_least_two_a_side(Photograph picture) {
  if (picture.width() > 1 && picture.height() > 1) {
    return picture;
  }
  return std::visit(
      [](const auto& image) {
        std::remove_cvref_t<decltype(image)> larger(std::max(2, image.width()),
                                                    std::max(2, image.height()), image.channels());
        for (int y = 0; y < larger.height(); ++y) {
          for (int x = 0; x < larger.width(); ++x) {
            for (int c = 0; c < larger.channels(); ++c) {
              larger.at(x, y, c) = image.at(x % image.width(), y % image.height(), c);
            }
          }
        }
        return Photograph{std::move(larger)};
      },
      picture.pixels);
}

}  // namespace

SegmentWriter::SegmentWriter(const SequenceOptions& options, const SequenceLayout& layout,
                             ImageExtent frame_size, Execution& execution)
    : options_(options), layout_(layout), frame_size_(frame_size), execution_(execution) {
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

void SegmentWriter::write(Stream& stream, const Photograph& picture, int times) {
  try {
    if (!stream.writer) {
      const SequenceOutput output = stream.output->output;
      const FilmFormat format = film_format_of(output, options_.film);
      stream.writer = std::make_unique<VideoWriter>(
          layout_.segment(*stream.output, frames_), picture.width(), picture.height(),
          VideoEncoding{options_.frame_rate, options_.crf,
                        output == SequenceOutput::kDepthVideo ? options_.depth_coding
                                                              : colour_coding(format.colours),
                        format});
    }
    for (int i = 0; i < times; ++i) {
      stream.writer->write(picture);
    }
  } catch (const Error& error) {
    throw OutputError(error.what());
  }
}

void SegmentWriter::add(const FrameSlot& slot) {
  // One task per video: an encoder uses one thread, so that its bytes are deterministic.
  execution_.executor().parallel_for(static_cast<int>(streams_.size()), [&](int index) {
    Stream& stream = streams_[static_cast<std::size_t>(index)];
    copy_picture(slot, *stream.output, options_.match.reference, stream.last);
    stream.last = at_least_two_a_side(std::move(stream.last));
    write(stream, stream.last, 1 + std::exchange(stream.leading_skipped, 0));
  });
}

void SegmentWriter::add_skipped() {
  for (Stream& stream : streams_) {
    if (stream.writer) {
      write(stream, stream.last, 1);
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
    return at_least_two_a_side(Photograph{std::move(unknown)});
  }
  Photograph black{Image<std::uint8_t>(size.width_px, size.height_px)};
  std::get<Image<std::uint8_t>>(black.pixels).fill(0);
  if (output.output != SequenceOutput::kStereo) {
    return at_least_two_a_side(std::move(black));
  }
  Photograph packed;
  show_stereo(black, black, options_.stereo_packing, packed);
  return at_least_two_a_side(std::move(packed));
}

std::vector<std::unique_ptr<VideoWriter>> SegmentWriter::end(FrameRange frames) {
  std::vector<std::unique_ptr<VideoWriter>> videos(streams_.size());
  // The streams have the same frames: all have pictures, or none has.
  if (!streams_.front().writer && streams_.front().leading_skipped == 0) {
    return {};
  }
  execution_.executor().parallel_for(static_cast<int>(streams_.size()), [&](int index) {
    Stream& stream = streams_[static_cast<std::size_t>(index)];
    if (!stream.writer) {
      write(stream, black_picture(*stream.output), std::exchange(stream.leading_skipped, 0));
    }
    try {
      stream.writer->end_encoding();
      if (frames != frames_) {
        stream.writer->rename(layout_.segment(*stream.output, frames));
      }
    } catch (const Error& error) {
      throw OutputError(error.what());
    }
    videos[static_cast<std::size_t>(index)] = std::move(stream.writer);
  });
  return_free_memory();
  return videos;
}

}  // namespace vantage
