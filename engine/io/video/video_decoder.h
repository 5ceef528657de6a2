#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/io/video/cut_video.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/video_timing.h"

namespace vantage {

/// The decoder of `stream`, open. Throws Error naming `name` when there is none.
LibavCodec open_decoder(const AVStream& stream, int threads, const std::string& name);
/// FFmpeg's name of its codec; empty where that is lossless.
std::string name_of_lossy_codec(const AVStream& stream);

/// Decodes the video of a file, frame by frame in order of presentation. Never returns a damaged
/// frame, nor any after it, which may refer to it. Thread rule: one thread at a time.
class VideoDecoder {
 public:
  enum class Step { kFrame, kEnd, kDamaged };

  /// With one thread all frames before a damaged one are returned; with more, the frames in flight
  /// are lost if the decoder finds the damage. A video cut so that decoders miss frames is always
  /// decoded with one thread. Throws Error when the file has no video, or none that can be decoded.
  VideoDecoder(const std::filesystem::path& path, int threads, int track = kMainVideo);

  [[nodiscard]] AVFormatContext& input() { return *input_; }
  [[nodiscard]] AVStream& stream() { return *stream_; }
  /// That will be decoded next; empty after the last one.
  [[nodiscard]] const AVPacket& next_packet() const { return *packet_; }

  /// Starts decoding at that packet; call it before any decoding. False when that is not possible,
  /// see begins_afresh(): try another one.
  bool start_at(const PossibleStart& start);
  Step next();
  /// The frame after kFrame, valid until the next next().
  [[nodiscard]] const AVFrame& frame() const { return *frame_; }
  /// Frames skipped at the start because they refer to removed frames.
  [[nodiscard]] int frames_cut_off() const { return cut_->frames_cut_off(); }
  /// After kDamaged: the problem.
  [[nodiscard]] const std::string& problem() const { return problem_; }
  /// After kDamaged: whether all frames before the damaged one were returned.
  [[nodiscard]] bool gave_all_before_damage() const { return gave_all_before_damage_; }

 private:
  Step check_frame();
  /// Reads the next packet of the video, or the reason why there is none.
  void read_packet();
  int read_from_file(AVPacket& packet);
  /// Whether the damage that the container reports is a splice: pictures of another size follow.
  bool is_before_another_size();
  /// "the size of the pictures changes there, from … to …", or empty: it does not at this packet.
  std::string change_of_size(const AVPacket& packet) const;
  /// Sends the packet read, or the end of the stream, to the decoder and reads the next one.
  void feed();
  enum class FoundBy { kDecoder, kFile };
  /// From now on only frames before `damaged_time`, in the stream's unit, are returned. False if
  /// this was called before.
  bool stop_feeding(const std::string& problem, std::int64_t damaged_time, FoundBy found_by);

  int threads_;
  LibavInput input_;
  AVStream* stream_;
  LibavCodec codec_;
  LibavFrame frame_ = make_libav_frame();
  LibavPacket packet_ = make_libav_packet();
  std::optional<CutVideo> cut_;
  int read_result_ = 0;            ///< FFmpeg's result for the packet
  std::deque<LibavPacket> ahead_;  ///< packets after it that were looked at
  bool is_spliced_ = false;        ///< one of the next packets has another size
  bool packet_is_cut_off_ = false;
  std::int64_t packet_time_ = 0;  ///< presentation time of the last packet sent to the decoder
  std::string problem_;
  bool gave_all_before_damage_ = true;
  std::int64_t damaged_time_ = 0;
};

}  // namespace vantage
