#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/video/frame_rate.h"
#include "engine/io/video/frame_source.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/streams/raw_video_shape.h"
#include "engine/io/video/streams/stream_input.h"
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
  /// frames then; when it is damaged, and the next one is the next that can be decoded alone. That
  /// one tells how many are missing before it.
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
  /// Lets the decoder give the frames before the damage.
  void note_damage(int result);
  [[noreturn]] void fail_damaged();
  /// Sets shown_s_ and frames_missing_ for the frame that was just decoded.
  void note_time();

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
  int decoded_ = 0;                ///< frames, and those left out for damage
  int damage_ = 0;                 ///< of the packet behind those that the decoder holds; 0: none
  int left_out_ = 0;               ///< frames, since the last good one
  int frames_missing_ = 0;         ///< beside them, before the last good one
  std::optional<double> shown_s_;  ///< when the last frame is shown, in seconds; empty: not known
  std::int64_t frames_end_ = -1;   ///< in bytes of the stream; -1: not known
  bool ended_ = false;
  VideoPicture first_;  ///< until it is fetched
};

}  // namespace vantage
