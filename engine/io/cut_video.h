#pragma once

#include <cstdint>

struct AVCodecParameters;
struct AVPacket;

namespace vantage {

/// Whether decoding that begins with this packet gives the same frames as decoding that comes from
/// before it, and shows none from before it later. Known of H.264 and of codings without
/// references.
bool begins_afresh(const AVPacket& packet, const AVCodecParameters& parameters);

/// Judges the packets, one after the other, of a video that may have been cut without encoding it
/// again. Only H.264 is known that well.
class CutVideo {
 public:
  explicit CutVideo(const AVCodecParameters& parameters) : parameters_(&parameters) {}

  /// Takes the next packet. True when it cannot be decoded because it is shown before the first
  /// one, and so refers to frames cut off. Players leave those frames out.
  bool is_cut_off(const AVPacket& packet);
  [[nodiscard]] int frames_cut_off() const { return frames_cut_off_; }

  /// Whether decoders may find frames wanting without anything being wrong: the video begins with a
  /// frame that others can be decoded from, but not with a fresh start, and up to the next such
  /// frame it speaks of frames cut off.
  [[nodiscard]] bool misses_frames() const { return misses_frames_; }

 private:
  const AVCodecParameters* parameters_;
  int packets_ = 0;
  int frames_cut_off_ = 0;
  std::int64_t first_time_ = 0;
  bool misses_frames_ = false;
};

}  // namespace vantage
