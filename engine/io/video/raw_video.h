#pragma once

#include <atomic>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/video/frame_conversion.h"
#include "engine/io/video/frame_rate.h"
#include "engine/io/video/frame_source.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/raw_video_shape.h"
#include "engine/io/video/stream_input.h"
#include "engine/io/video/video_picture.h"

namespace vantage {

/// The frames of a video that arrives once, without index: y4m, rawvideo of a given shape, or a
/// container that can be streamed. It goes forward only. Its length is not known: it counts
/// kUnknownFrames frames, and fetch() is false after the last one. Frames before the first one that
/// can be decoded alone are dropped, as of a camera that was on before.
class StreamedVideo final : public FrameSource {
 public:
  /// Waits for its first frame. Throws Error when it is empty or no video; scheduler::Interrupted
  /// when it is stopped before the first frame.
  StreamedVideo(std::unique_ptr<StreamInput> bytes, const std::optional<RawVideoShape>& raw,
                FrameRate raw_rate);

  /// Throws Error naming the frame: when the stream ends inside it or fails, and it has no more
  /// frames then; when it is damaged, and the next one is the next that can be decoded alone.
  bool fetch(FetchedFrame& frame) override;
  /// Reads and drops the frames up to it. Throws Error for frames that are over.
  void skip_to(int index) override;
  [[nodiscard]] int frame_count() const override { return kUnknownFrames; }
  [[nodiscard]] std::string describe(int index) const override;
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override { return rate_; }
  [[nodiscard]] FilmFormat film_format() const override { return format_; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {}; }
  [[nodiscard]] std::string identity() const override {
    return bytes_->shown_name() + ": a stream";
  }

 private:
  /// False after the last one.
  bool decode_next(VideoPicture& picture);
  /// Gives the decoder the next packet, or the end.
  void feed();
  [[noreturn]] void fail_cut();
  [[noreturn]] void fail_damaged(int result);

  std::unique_ptr<StreamInput> bytes_;
  LibavInput input_;  ///< reads bytes_
  AVStream* stream_ = nullptr;
  LibavCodec codec_;
  LibavPacket packet_;
  LibavFrame frame_;
  FrameRate rate_;
  FilmFormat format_;
  bool is_raw_;                       ///< frames are as many bytes each
  std::string lossy_codec_;           ///< empty: lossless
  bool waits_for_key_frame_ = true;   ///< packets before one cannot be decoded
  std::vector<std::string> remarks_;  ///< of the next frame
  std::shared_ptr<PictureConverters> converters_ = std::make_shared<PictureConverters>();
  int decoded_ = 0;               ///< frames
  std::int64_t frames_end_ = -1;  ///< in bytes of the stream; -1: not known
  bool ended_ = false;
  VideoPicture first_;  ///< until it is fetched
};

/// Writes frames to a stream as they come: y4m (4:2:0 with 8 or, of a film with more, 10 bits, in
/// the written_colours() of the film, of which y4m states the range; grey pictures of 16 bits as
/// mono16, full range), or rawvideo (rgb24; grey of 16 bits as gray16le).
/// Thread rule: one thread at a time.
class StreamedVideoWriter {
 public:
  /// `film`: what the pictures are made of.
  StreamedVideoWriter(std::FILE* stream, StreamFormat format, FrameRate rate,
                      const FilmFormat& film);

  /// All frames have the size and the depth of the first one. Throws Error when nobody reads
  /// the stream any longer, or the disk is full.
  void write(const Photograph& frame);

 private:
  void put(const void* bytes, std::size_t count);
  void put_header(const AVFrame& frame, bool is_grey);
  void put_planes(const AVFrame& frame);
  void put_rgb(const Photograph& frame);

  std::FILE* stream_;
  StreamFormat format_;
  FrameRate rate_;
  FilmFormat film_;
  bool has_header_ = false;
  FrameConversion convert_;
  std::vector<std::uint8_t> planes_;
};

}  // namespace vantage
