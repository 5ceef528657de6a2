#pragma once

#include <filesystem>

namespace vantage {

enum class VideoExtent {
  kWhole,
  kCutOff,        ///< some of its last frames are not there
  kWithoutIndex,  ///< an MP4 or MOV nothing of which can be shown
};

/// Whether the frames of a video file are there to its end, as far as its container says where that
/// is: the boxes of MP4 and MOV, the chunks of AVI, the elements of Matroska and WebM, the packets
/// of MPEG-TS (but for a cut between two). Others count as whole. Decoders show the part that is
/// there and say nothing. Throws Error when the file cannot be read.
VideoExtent find_video_extent(const std::filesystem::path& path);

/// Throws Error when the tables of an MP4 or MOV promise more samples than a file of its size can
/// hold, for each of which readers would take memory.
void check_video_tables(const std::filesystem::path& path);

/// Throws Error when it is not whole.
void check_video_is_whole(const std::filesystem::path& path);

}  // namespace vantage
