#pragma once

#include <string_view>
#include <utility>
#include <vector>

namespace vantage {

/// How videos are coded, and in which container.
enum class VideoCoding {
  kH264,           ///< colours, yuv420p, MP4
  kHuffYuv_16,     ///< grey, 16 bits, lossless, Matroska: FFmpeg's variant of HuffYUV
  kFfv1_16,        ///< grey, 16 bits, lossless, Matroska
  kFfv1_10,        ///< grey, 10 bits, lossless, Matroska
  kHevc_10,        ///< grey, 10 bits, lossy, MP4
  kProRes_10,      ///< grey as the luma of 4:2:2 video with 10 bits, lossy, MOV
  kHevcColours_10  ///< colours, yuv420p10 (Main 10), MP4
};

/// What a coding is: a line of the table in the .cc file, where another one is added.
struct VideoCodingTraits {
  std::string_view name;       ///< on the command line: ffvhuff-16, ffv1-16, hevc-10, …
  std::string_view extension;  ///< of the files, without the dot
  int bits = 8;
  const char* encoder = "";     ///< FFmpeg's name
  int pixel_format = 0;         ///< FFmpeg's number, AV_PIX_FMT_…
  bool has_full_range = false;  ///< else 16 to 235, with 8 bits
  bool has_odd_sizes = false;   ///< and every frame can be decoded alone
  bool has_crf = false;
  /// Frames that are encoded together, from the first one on, and decoded without others.
  int group_frames = 1;
  /// Options of the encoder, as KEY=VALUE separated by commas. They choose the same algorithm on
  /// every processor, one thread, and headers that do not depend on the pictures. So the bytes
  /// depend on the frames only, and segments can be joined.
  const char* options = "";
};

const VideoCodingTraits& traits_of(VideoCoding coding);
/// The grey ones by name.
const std::vector<std::pair<std::string_view, VideoCoding>>& grey_coding_names();
constexpr bool is_grey(VideoCoding coding) {
  return coding != VideoCoding::kH264 && coding != VideoCoding::kHevcColours_10;
}

}  // namespace vantage
