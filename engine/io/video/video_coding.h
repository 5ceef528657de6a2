#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace vantage {

/// How videos are coded, and in which container.
enum class VideoCoding {
  kH264,      ///< colours, yuv420p, MP4
  kFfv1_16,   ///< grey, 16 bits, lossless, Matroska
  kFfv1_10,   ///< grey, 10 bits, lossless, Matroska
  kHevc_10,   ///< grey, 10 bits, lossy, MP4
  kProRes_10  ///< grey as the luma of 4:2:2 video with 10 bits, lossy, MOV
};

/// Names of the grey ones on the command line: ffv1-16, ffv1-10, hevc-10, prores-10.
const std::vector<std::pair<std::string_view, VideoCoding>>& grey_coding_names();

/// Of the files, without the dot.
std::string_view extension_of(VideoCoding coding);

constexpr bool is_grey(VideoCoding coding) { return coding != VideoCoding::kH264; }
/// Bits of the values of a grey coding.
constexpr int bits_of(VideoCoding coding) { return coding == VideoCoding::kFfv1_16 ? 16 : 10; }

}  // namespace vantage
