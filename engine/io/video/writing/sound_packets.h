#pragma once

#include <memory>
#include <string>

#include "engine/io/video/libav.h"
#include "engine/io/video/writing/video_join.h"

struct AVCodecParameters;
struct AVRational;

namespace vantage {

/// The sound packets of a part of a video file, starting shortly before it. Times are seconds from
/// the start of the part, which is relative to the first frame of the video. Thread rule: one
/// thread at a time.
class SoundInput {
 public:
  /// Throws Error when the file is missing or not a video.
  explicit SoundInput(const SoundTrack& track);

  /// Null when there is no sound.
  [[nodiscard]] AVStream* stream() const { return stream_; }
  [[nodiscard]] double length_seconds() const { return length_seconds_; }
  /// Reads the next packet that starts before the end of the part; false when there is none. A
  /// truncated file has sound up to the cut.
  bool read(AVPacket& packet);
  /// Presentation time in seconds of `time`, in the stream's unit.
  [[nodiscard]] double seconds(long long time) const;
  /// Inverse of seconds() at 0, in the stream's unit, rounded.
  [[nodiscard]] long long start_time() const;

  [[noreturn]] void fail(const std::string& problem) const;

 private:
  std::string name_;
  double begin_seconds_;  ///< in the time of the file
  double length_seconds_;
  LibavInput input_;
  AVStream* stream_;
};

/// The packets of a part of a sound track, in order, ready for an MP4. Times are relative to the
/// start of the part; the first ones may be negative, for samples that are only decoded. Thread
/// rule: one thread at a time.
class SoundPackets {
 public:
  SoundPackets() = default;
  SoundPackets(const SoundPackets&) = delete;
  SoundPackets& operator=(const SoundPackets&) = delete;
  virtual ~SoundPackets() = default;

  /// Parameters of the output stream.
  [[nodiscard]] virtual const AVCodecParameters& parameters() const = 0;
  [[nodiscard]] virtual AVRational time_unit() const = 0;
  /// Advances to the next packet; false after the last one. Throws Error naming the file when it is
  /// damaged.
  virtual bool next() = 0;
  /// Valid after next(). The caller may move it away.
  [[nodiscard]] AVPacket& packet() const { return *packet_; }
  [[nodiscard]] double seconds() const;

 private:
  LibavPacket packet_ = make_libav_packet();
};

/// Decodes the sound of `input`, which must have some, cuts it to the part's samples and encodes it
/// as AAC: mono stays mono, everything else becomes stereo. Throws Error naming the file when it
/// cannot be decoded.
std::unique_ptr<SoundPackets> make_encoded_sound(SoundInput input);

/// Copies packets if MP4 can hold them and browsers play them, otherwise encodes AAC. Null when
/// there is no sound. Throws Error naming the file when it is missing or damaged.
std::unique_ptr<SoundPackets> open_sound_packets(const SoundTrack& track);

}  // namespace vantage
