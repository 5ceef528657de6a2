#pragma once

#include <memory>

#include "engine/io/video/libav.h"
#include "engine/io/video/video_join.h"

struct AVCodecParameters;
struct AVRational;

namespace vantage {

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

/// Copies packets if MP4 can hold them and browsers play them, otherwise encodes AAC. Null when
/// there is no sound. Throws Error naming the file when it is missing or damaged.
std::unique_ptr<SoundPackets> open_sound_packets(const SoundTrack& track);

}  // namespace vantage
