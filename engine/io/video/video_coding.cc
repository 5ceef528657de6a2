#include "engine/io/video/video_coding.h"

namespace vantage {

const std::vector<std::pair<std::string_view, VideoCoding>>& grey_coding_names() {
  static const std::vector<std::pair<std::string_view, VideoCoding>> names = {
      {"ffv1-16", VideoCoding::kFfv1_16},
      {"ffv1-10", VideoCoding::kFfv1_10},
      {"hevc-10", VideoCoding::kHevc_10},
      {"prores-10", VideoCoding::kProRes_10}};
  return names;
}

std::string_view extension_of(VideoCoding coding) {
  switch (coding) {
    case VideoCoding::kFfv1_16:
    case VideoCoding::kFfv1_10:
      return "mkv";
    case VideoCoding::kProRes_10:
      return "mov";
    case VideoCoding::kH264:
    case VideoCoding::kHevc_10:
      break;
  }
  return "mp4";
}

}  // namespace vantage
