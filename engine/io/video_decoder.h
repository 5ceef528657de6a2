#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/io/cut_video.h"
#include "engine/io/libav.h"
#include "engine/io/video_timing.h"

namespace vantage {

/// Decodes the video of a file, frame by frame in order of presentation. A damaged frame is never
/// given out, nor any behind it, which may refer to it.
/// Thread rule: one thread at a time.
class VideoDecoder {
 public:
  enum class Step { kFrame, kEnd, kDamaged };

  /// With one thread all frames before a damaged one are given out; with more, the frames under
  /// way are lost when it is the decoder that finds the damage. A video that was cut where decoders
  /// miss frames is decoded with one thread anyway. Throws Error when the file has no video, or
  /// none that can be decoded.
  VideoDecoder(const std::filesystem::path& path, int threads);

  [[nodiscard]] AVFormatContext& input() { return *input_; }
  [[nodiscard]] AVStream& stream() { return *stream_; }

  /// Has decoding, of which there was none yet, begin with that packet. False when it cannot, see
  /// begins_afresh(): try another one.
  bool begin_at(const PossibleStart& start);
  Step next();
  /// The frame after kFrame, until next() is called again.
  [[nodiscard]] const AVFrame& frame() const { return *frame_; }
  /// Frames left out at the beginning because they refer to what has been cut off before it.
  [[nodiscard]] int frames_cut_off() const { return cut_->frames_cut_off(); }
  /// After kDamaged: what is wrong.
  [[nodiscard]] const std::string& problem() const { return problem_; }
  /// After kDamaged: whether all frames before the damaged one were given out.
  [[nodiscard]] bool gave_all_before_damage() const { return gave_all_before_damage_; }

 private:
  Step check_frame();
  /// Reads the next packet of the video, or the reason why there is none.
  void read_packet();
  /// Gives the decoder the packet read, or tells it that there is none, and reads the next.
  void feed();
  enum class FoundBy { kDecoder, kFile };
  /// From now on only frames before `damaged_time`, in the stream's unit, are given out. False when
  /// that has been said before.
  bool stop_feeding(const std::string& problem, std::int64_t damaged_time, FoundBy found_by);

  int threads_;
  LibavInput input_;
  AVStream* stream_;
  LibavCodec codec_;
  LibavFrame frame_ = make_libav_frame();
  LibavPacket packet_ = make_libav_packet();
  std::optional<CutVideo> cut_;
  int read_result_ = 0;  ///< FFmpeg's, of the packet
  bool packet_is_cut_off_ = false;
  std::int64_t packet_time_ = 0;  ///< when the last packet given to the decoder is shown
  std::string problem_;
  bool gave_all_before_damage_ = true;
  std::int64_t damaged_time_ = 0;
};

}  // namespace vantage
