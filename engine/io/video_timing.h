#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "engine/io/frame_rate.h"

struct AVFormatContext;
struct AVStream;

namespace vantage {

/// A packet that decoding may be able to begin with.
struct PossibleStart {
  int frame = 0;              ///< its number, in order of presentation, if decoding can begin there
  std::int64_t time = 0;      ///< when it is decoded, in the stream's unit
  std::int64_t position = 0;  ///< in the file
};

/// What a video file tells about its frames before any of them is decoded.
struct VideoTiming {
  /// Frames it promises. Of a file that is cut off and has no index: those that are there and the
  /// one that is cut.
  int frames = 0;
  /// Frames that may be missing at its end without anything being wrong.
  int frames_uncertain = 0;
  std::optional<FrameRate> rate;
  /// Set when the file is cut off: frames shown before this time, in the stream's unit, are all
  /// there; of those behind it, some may be missing between others.
  std::optional<std::int64_t> cut_time;
  /// When the last packet is decoded; set where the container does not say where the file ends, as
  /// in MPEG streams. Frames missing before one that is shown later were to follow it.
  std::optional<std::int64_t> last_decoded;
  /// Behind the first frame, in order; none where the file has no index of all its frames.
  std::vector<PossibleStart> starts;
};

/// Reads the index of an MP4 or MOV, and all packets of the video in other containers. `input` and
/// `stream` are the open file `path`, and are left as they are. Throws Error when it has no frames,
/// or is an MP4 or MOV without index.
VideoTiming examine_video_timing(AVFormatContext& input, AVStream& stream,
                                 const std::filesystem::path& path);

}  // namespace vantage
