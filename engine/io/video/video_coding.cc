#include "engine/io/video/video_coding.h"

#include <array>
#include <cstddef>

extern "C" {
#include <libavutil/pixfmt.h>
}

namespace vantage {
namespace {

/// In the order of VideoCoding.
///
/// x264: "veryfast" with half of its search for motion, where views of photographs take half the
/// time for 3 to 8 % more bytes of the same PSNR (docs/SEQUENCES.md has the table). Its lookahead
/// stays: "superfast" has none, and takes 10 to 50 % more bytes. No tuning: views are of any kind.
constexpr std::array kCodings = {
    VideoCodingTraits{.name = "h264",
                      .extension = "mp4",
                      .encoder = "libx264",
                      .pixel_format = AV_PIX_FMT_YUV420P,
                      .has_crf = true,
                      .group_frames = 50,
                      .options = "preset=veryfast,x264-params=subme=1:me=dia:partitions=none:cpu-"
                                 "independent=1:stitchable=1"},
    // Where FFV1 takes 93 ms for a depth picture of 1920×1080, this takes 7 ms, for 19 % more
    // bytes.
    VideoCodingTraits{.name = "ffvhuff-16",
                      .extension = "mkv",
                      .bits = 16,
                      .encoder = "ffvhuff",
                      .pixel_format = AV_PIX_FMT_GRAY16LE,
                      .has_full_range = true,
                      .has_odd_sizes = true,
                      .options = "pred=plane"},
    VideoCodingTraits{.name = "ffv1-16",
                      .extension = "mkv",
                      .bits = 16,
                      .encoder = "ffv1",
                      .pixel_format = AV_PIX_FMT_GRAY16LE,
                      .has_full_range = true,
                      .has_odd_sizes = true,
                      .options = "level=3,coder=range_def,slicecrc=1"},
    VideoCodingTraits{.name = "ffv1-10",
                      .extension = "mkv",
                      .bits = 10,
                      .encoder = "ffv1",
                      .pixel_format = AV_PIX_FMT_GRAY10LE,
                      .has_full_range = true,
                      .has_odd_sizes = true,
                      .options = "level=3,coder=range_def,slicecrc=1"},
    VideoCodingTraits{.name = "hevc-10",
                      .extension = "mp4",
                      .bits = 10,
                      .encoder = "libx265",
                      .pixel_format = AV_PIX_FMT_GRAY10LE,
                      .has_full_range = true,
                      .has_crf = true,
                      .group_frames = 50,
                      .options = "preset=fast,x265-params=log-level=none:pools=none:"
                                 "frame-threads=1:bframes=0:open-gop=0:info=0:range=full"},
    VideoCodingTraits{.name = "prores-10",
                      .extension = "mov",
                      .bits = 10,
                      .encoder = "prores_ks",
                      .pixel_format = AV_PIX_FMT_YUV422P10LE,
                      .options = "profile=hq"},
    VideoCodingTraits{.name = "hevc-colours-10",
                      .extension = "mp4",
                      .bits = 10,
                      .encoder = "libx265",
                      .pixel_format = AV_PIX_FMT_YUV420P10LE,
                      .has_crf = true,
                      .group_frames = 50,
                      .options = "preset=superfast,x265-params=log-level=none:pools=none:"
                                 "frame-threads=1:bframes=0:open-gop=0:info=0"}};

}  // namespace

const VideoCodingTraits& traits_of(VideoCoding coding) {
  return kCodings.at(static_cast<std::size_t>(coding));
}

const std::vector<std::pair<std::string_view, VideoCoding>>& grey_coding_names() {
  static const auto kNames = [] {
    std::vector<std::pair<std::string_view, VideoCoding>> names;
    for (std::size_t i = 1; i < kCodings.size(); ++i) {
      if (is_grey(static_cast<VideoCoding>(i))) {
        names.emplace_back(kCodings[i].name, static_cast<VideoCoding>(i));
      }
    }
    return names;
  }();
  return kNames;
}

}  // namespace vantage
