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
#include "engine/io/video/standard_input.h"
#include "engine/io/video/video_picture.h"

namespace vantage {

/// The frames of a video that arrives once, without index: y4m, or rawvideo of a given shape. It
/// goes forward only. Its length is not known: it counts kUnknownFrames frames, and fetch() is
/// false after the last one.
class StreamedVideo final : public FrameSource {
 public:
  /// Reads standard input, which ends once `stop`, which may be null, is set. Throws Error when it
  /// is empty, or not a y4m video; scheduler::Interrupted when it is stopped before the first
  /// frame.
  StreamedVideo(const std::optional<RawVideoShape>& raw, FrameRate raw_rate,
                const std::atomic<bool>* stop);

  /// Throws Error naming the frame when the stream ends inside it; it has no more frames then.
  bool fetch(FetchedFrame& frame) override;
  /// Reads and drops the frames up to it. Throws Error for frames that are over.
  void skip_to(int index) override;
  [[nodiscard]] int frame_count() const override { return kUnknownFrames; }
  [[nodiscard]] std::string describe(int index) const override;
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override { return rate_; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {}; }
  [[nodiscard]] std::string identity() const override { return "standard input: a stream"; }

 private:
  /// False after the last one.
  bool decode_next(VideoPicture& picture);
  [[noreturn]] void fail_cut();

  std::unique_ptr<StandardInput> bytes_;
  LibavInput input_;  ///< reads bytes_
  AVStream* stream_ = nullptr;
  LibavCodec codec_;
  LibavPacket packet_;
  LibavFrame frame_;
  FrameRate rate_;
  std::shared_ptr<PictureConverters> converters_ = std::make_shared<PictureConverters>();
  int decoded_ = 0;               ///< frames
  std::int64_t frames_end_ = -1;  ///< in bytes of the stream; -1: not known
  bool ended_ = false;
  VideoPicture first_;  ///< until it is fetched
};

/// Writes frames to a stream as they come: y4m (4:2:0 with 8 bits, BT.709, limited range; grey
/// pictures of 16 bits as mono16, full range), or rawvideo (rgb24; grey of 16 bits as gray16le).
/// Thread rule: one thread at a time.
class StreamedVideoWriter {
 public:
  StreamedVideoWriter(std::FILE* stream, StreamFormat format, FrameRate rate);

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
  bool has_header_ = false;
  FrameConversion convert_;
  std::vector<std::uint8_t> planes_;
};

}  // namespace vantage
