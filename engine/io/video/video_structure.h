#pragma once

#include <filesystem>
#include <string_view>

namespace vantage {

// Our own reader of containers' structure, because FFmpeg opens truncated files without a word, and
// allocates an entry for each sample that a table promises.

enum class VideoExtent {
  kWhole,
  kCutOff,        ///< some of its last frames are missing
  kWithoutIndex,  ///< an MP4 or MOV without its index: nothing can be shown
};

/// Whether the frames of a video file are complete, as far as its container shows: the boxes of MP4
/// and MOV, the chunks of AVI, the elements of Matroska and WebM, the packets of MPEG-TS (except
/// for a cut between two). Others count as complete. Decoders silently show the existing part.
/// Throws Error when the file cannot be read.
VideoExtent find_video_extent(const std::filesystem::path& path);

/// Throws Error when the tables of an MP4 or MOV promise more samples than a file of its size can
/// hold, for each of which readers would allocate memory.
void check_video_tables(const std::filesystem::path& path);

/// "MV-HEVC" or "MVC" where the boxes of an MP4 or MOV describe further views beside the one that
/// FFmpeg decodes, and no packing of both in one picture; else empty.
std::string_view further_views_in_boxes(const std::filesystem::path& path);

/// Throws Error when it is incomplete.
void check_video_is_whole(const std::filesystem::path& path);

}  // namespace vantage
