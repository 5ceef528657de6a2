#include "engine/io/video/libav_functions.h"

extern "C" {
#include <libavutil/macros.h>
}

namespace vantage {
namespace {

constexpr const char* kWithoutThem = "cannot read or write videos";

}  // namespace

// The major versions of the headers: FFmpeg changes types only between major versions.
LibavFunctions::LibavFunctions()
    : format_("libavformat.so." AV_STRINGIFY(LIBAVFORMAT_VERSION_MAJOR), kWithoutThem),
      codec_("libavcodec.so." AV_STRINGIFY(LIBAVCODEC_VERSION_MAJOR), kWithoutThem) {}

const LibavFunctions& libav() {
  static const LibavFunctions functions;
  return functions;
}

}  // namespace vantage
