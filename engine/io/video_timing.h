#pragma once

#include <filesystem>
#include <optional>

#include "engine/io/frame_rate.h"

struct AVFormatContext;
struct AVStream;

namespace vantage {

/// What a video file tells about its frames before any of them is decoded.
struct VideoTiming {
  /// Frames it promises.
  int frames = 0;
  /// Frames that may be missing at its end without anything being wrong.
  int frames_uncertain = 0;
  std::optional<FrameRate> rate;
};

/// Reads the index of an MP4 or MOV, and all packets of the video in other containers. `input` and
/// `stream` are the open file `path`, and are left as they are. Throws Error when it has no frames.
VideoTiming examine_video_timing(AVFormatContext& input, AVStream& stream,
                                 const std::filesystem::path& path);

}  // namespace vantage
