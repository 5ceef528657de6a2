#pragma once

#include <memory>

#include "engine/io/libav.h"
#include "engine/io/video_join.h"

struct AVCodecParameters;
struct AVRational;

namespace vantage {

/// The packets of a sound track's part, one after the other, as an MP4 takes them. Times count from
/// the beginning of the part; the first ones may be negative, of samples that are only decoded.
/// Thread rule: one thread at a time.
class SoundPackets {
 public:
  SoundPackets() = default;
  SoundPackets(const SoundPackets&) = delete;
  SoundPackets& operator=(const SoundPackets&) = delete;
  virtual ~SoundPackets() = default;

  /// Of the stream to write.
  [[nodiscard]] virtual const AVCodecParameters& parameters() const = 0;
  [[nodiscard]] virtual AVRational time_unit() const = 0;
  /// Goes to the next packet; false after the last one. Throws Error naming the file when it is
  /// damaged.
  virtual bool next() = 0;
  /// After next(). The caller may take it away.
  [[nodiscard]] AVPacket& packet() const { return *packet_; }
  [[nodiscard]] double seconds() const;

 private:
  LibavPacket packet_ = make_libav_packet();
};

/// Copies packets where MP4 can hold them and browsers play them, encodes AAC otherwise. Null when
/// there is no sound. Throws Error naming the file when it is missing or damaged.
std::unique_ptr<SoundPackets> open_sound_packets(const SoundTrack& track);

}  // namespace vantage
