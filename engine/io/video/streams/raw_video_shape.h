#pragma once

#include <string>

namespace vantage {

/// What rawvideo, which has no header, consists of.
struct RawVideoShape {
  int width_px = 0;                    ///< 1..65535
  int height_px = 0;                   ///< 1..65535
  std::string pixel_format = "rgb24";  ///< one of FFmpeg's names: rgb24, gray, gray16le, yuv420p …
  friend bool operator==(const RawVideoShape&, const RawVideoShape&) = default;
};

/// How videos are written to a stream.
enum class StreamFormat { kY4m, kRawVideo };

}  // namespace vantage
