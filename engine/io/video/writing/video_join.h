#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "engine/io/video/frame_rate.h"

namespace vantage {

// Our own joining, because FFmpeg's (concat) shifts each file by the duration of those before it,
// which containers round.

/// A part of another video's sound.
struct SoundTrack {
  std::filesystem::path video;  ///< empty: no sound, as for a video without sound
  double begin_seconds = 0;     ///< aligned with the start of the joined video
  double end_seconds = 0;
};

/// Concatenates the videos `segments` (at least one, all made by VideoWriter with the same size and
/// encoding) to `output`, of the same extension, without re-encoding, and adds the sound, copied if
/// MP4 can hold it and else as AAC. `times`: of as many frames, shown from the first one on;
/// Matroska rounds them to milliseconds. Empty: a constant rate. Writes atomically; the bytes
/// depend on the inputs only. Sound that cannot be decoded or written is left out: returns the
/// reason, else "". Throws Error naming the missing file (also that of the sound), or the segment
/// that is damaged or does not match.
std::string join_videos(std::span<const std::filesystem::path> segments, FrameRate rate,
                        const SoundTrack& sound, const std::filesystem::path& output,
                        const std::optional<FrameTimes>& times = {});

}  // namespace vantage
