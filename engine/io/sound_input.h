#pragma once

#include <string>

#include "engine/io/libav.h"
#include "engine/io/video_join.h"

namespace vantage {

/// The packets of a video file's sound, from shortly before a part of it on. Times are seconds from
/// the beginning of the part, which counts from the first frame of the video.
/// Thread rule: one thread at a time.
class SoundInput {
 public:
  /// Throws Error when the file is missing or not a video.
  explicit SoundInput(const SoundTrack& track);

  /// Null when there is no sound.
  [[nodiscard]] AVStream* stream() const { return stream_; }
  [[nodiscard]] double length_seconds() const { return length_seconds_; }
  /// Reads the next packet that begins before the end of the part; false when there is none. A file
  /// that is cut off has sound up to the cut.
  bool read(AVPacket& packet);
  /// When something at `time`, in the stream's unit, is heard.
  [[nodiscard]] double seconds(long long time) const;
  /// seconds() of 0, in the stream's unit, rounded.
  [[nodiscard]] long long begin_time() const;

  [[noreturn]] void fail(const std::string& problem) const;

 private:
  std::string name_;
  double begin_seconds_;  ///< on the clock of the file
  double length_seconds_;
  LibavInput input_;
  AVStream* stream_;
};

}  // namespace vantage
