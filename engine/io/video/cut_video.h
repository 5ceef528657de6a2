#pragma once

#include <cstdint>

struct AVCodecParameters;
struct AVPacket;

namespace vantage {

// Our own look at H.264, because FFmpeg marks as key frames also those after which frames from
// before are shown.

/// Whether decoding from this packet gives the same frames as decoding from an earlier one, and
/// later shows no earlier frame. Known for H.264 and for intra-only codecs.
bool begins_afresh(const AVPacket& packet, const AVCodecParameters& parameters);

/// Checks the packets, in order, of a video that may have been cut without re-encoding. Supports
/// H.264 only.
class CutVideo {
 public:
  explicit CutVideo(const AVCodecParameters& parameters) : parameters_(&parameters) {}

  /// Takes the next packet. True when it cannot be decoded because it is shown before the first
  /// one, and so refers to removed frames. Players skip those frames.
  bool is_cut_off(const AVPacket& packet);
  [[nodiscard]] int frames_cut_off() const { return frames_cut_off_; }

  /// Whether decoders may report missing frames although nothing is wrong: the video starts with a
  /// frame that others can be decoded from, but not with a clean random access point, and up to the
  /// next such frame it refers to removed frames.
  [[nodiscard]] bool misses_frames() const { return misses_frames_; }

 private:
  const AVCodecParameters* parameters_;
  int packets_ = 0;
  int frames_cut_off_ = 0;
  std::int64_t first_time_ = 0;
  bool misses_frames_ = false;
};

}  // namespace vantage
