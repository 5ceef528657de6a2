#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "engine/io/frame_rate.h"

namespace vantage {

/// A part of another video's sound.
struct SoundTrack {
  std::filesystem::path video;  ///< empty: none. A video without sound gives none either.
  double begin_seconds = 0;     ///< goes to the beginning of the joined video
  double end_seconds = 0;
};

/// Puts the videos `segments` (at least one, all made by VideoWriter with the same size and
/// encoding) one behind the other into the MP4 `output`, without encoding anything again, and adds
/// the sound, copied where MP4 can hold it and as AAC where it cannot. The file appears whole or
/// not at all; its bytes depend on the inputs only. Sound that cannot be decoded or written is left
/// out: returns why, "" when nothing was left out. Throws Error naming the file that is missing
/// (that of the sound, too), or the segment that is damaged or does not fit.
std::string join_videos(std::span<const std::filesystem::path> segments, FrameRate rate,
                        const SoundTrack& sound, const std::filesystem::path& output);

}  // namespace vantage
