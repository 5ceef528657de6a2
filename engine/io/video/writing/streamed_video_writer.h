#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/io/video/film_format.h"
#include "engine/io/video/frame_rate.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/streams/raw_video_shape.h"
#include "engine/io/video/writing/frame_conversion.h"
#include "engine/io/video/writing/stream_output.h"

namespace vantage {

/// Writes frames to a stream as they come: y4m (4:2:0 with 8 or, of a film with more, 10 bits, in
/// the written_colours() of the film, of which y4m states the range; grey pictures of 16 bits as
/// mono16, full range), or rawvideo (rgb24; grey of 16 bits as gray16le).
/// Thread rule: one thread at a time.
class StreamedVideoWriter {
 public:
  /// `film`: what the pictures are made of.
  StreamedVideoWriter(StreamOutput output, StreamFormat format, FrameRate rate,
                      const FilmFormat& film);

  /// All frames have the size and the depth of the first one. Throws what StreamOutput::put() does.
  void write(const Photograph& frame);

 private:
  void add_header(const AVFrame& frame, bool is_grey);
  void add_planes(const AVFrame& frame);
  void add_rgb(const Photograph& frame);

  StreamOutput output_;
  StreamFormat format_;
  FrameRate rate_;
  FilmFormat film_;
  bool has_header_ = false;
  FrameConversion convert_;
  std::vector<std::uint8_t> bytes_;  ///< of the frame
};

}  // namespace vantage
