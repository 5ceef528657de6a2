#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "engine/io/video/frame_rate.h"

struct AVFormatContext;
struct AVStream;

namespace vantage {

/// A packet at which decoding may be able to start.
struct PossibleStart {
  int frame = 0;              ///< its index, in order of presentation, if decoding can start there
  std::int64_t time = 0;      ///< decoding time, in the stream's unit
  std::int64_t position = 0;  ///< in the file
};

/// Properties of a video file's frames known before decoding.
struct VideoTiming {
  /// Promised frames. In a truncated file without index: the existing ones, including the
  /// incomplete one.
  int frames = 0;
  /// Frames that may be missing at its end without an error.
  int frames_uncertain = 0;
  std::optional<FrameRate> rate;
  /// Set for a truncated file: all frames presented before this time, in the stream's unit, exist;
  /// later ones may have gaps.
  std::optional<std::int64_t> cut_time;
  /// Decoding time of the last packet; set if the container does not define the end of the file, as
  /// in MPEG streams. Frames missing before a later presented one would have followed it.
  std::optional<std::int64_t> last_decoded;
  /// Possible starts after the first frame, in order; empty if the file has no index of all its
  /// frames.
  std::vector<PossibleStart> starts;
  /// Set for progressive video of variable rate that knows the times of all its frames.
  std::optional<FrameTimes> frame_times;
  /// Set for video that knows the times of all its frames: those, or those of the rate.
  std::optional<FilmStart> start;
};

/// Reads the index of an MP4 or MOV, and all packets of the video in other containers, and where
/// the rate is variable and the index only has times of decoding. `input` and `stream` are the open
/// file `path`; their state is restored. Throws Error when it has no frames, or is an MP4 or MOV
/// without index.
VideoTiming examine_video_timing(AVFormatContext& input, AVStream& stream,
                                 const std::filesystem::path& path);

}  // namespace vantage
