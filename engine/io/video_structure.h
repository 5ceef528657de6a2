#pragma once

#include <filesystem>

namespace vantage {

/// Checks that a video file is there to its end, as far as its container says how long it is: the
/// boxes of MP4 and MOV, the chunk of AVI, the segment of Matroska and WebM. Decoders show the part
/// that is there and say nothing. Throws Error; says nothing about other containers.
void check_video_is_whole(const std::filesystem::path& path);

}  // namespace vantage
