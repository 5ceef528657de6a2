#pragma once

#include <string>

#include "engine/io/video/libav.h"
#include "engine/io/video/video_join.h"

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

}  // namespace vantage
