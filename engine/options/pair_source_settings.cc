#include "engine/options/pair_source_settings.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "engine/options/frame_step_setting.h"

namespace vantage {
namespace {

constexpr int kMaxSide_px = 65535;

/// Binds --raw-video.
void add_raw_video_setting(Settings& settings, std::optional<RawVideoShape>& shape) {
  Setting& setting =
      settings.add("raw-video", "WxH[:FORMAT]",
                   "Streams are rawvideo of this size, in one of FFmpeg's pixel formats (default "
                   "rgb24), with the frame rate of --fps; of a camera its mode; none: y4m, or a "
                   "container that can be streamed");
  setting.words = {"none"};
  setting.set = [&shape](const SettingValue& value) {
    const std::string text = to_text(value);
    if (text == "none") {
      shape.reset();
      return;
    }
    const std::size_t colon = text.find(':');
    const auto size = two_numbers(text.substr(0, colon), 'x');
    const std::string format = colon == std::string::npos ? "rgb24" : text.substr(colon + 1);
    if (!size || size->first < 1 || size->second < 1 || size->first > kMaxSide_px ||
        size->second > kMaxSide_px || format.empty()) {
      reject_value(value, "a size such as 1920x1080, or with a format 1920x1080:yuv420p, or none");
    }
    shape = RawVideoShape{size->first, size->second, format};
  };
  setting.get = [&shape]() -> SettingValue {
    return shape ? fmt::format("{}x{}:{}", shape->width_px, shape->height_px, shape->pixel_format)
                 : "none";
  };
}

}  // namespace

void add_pair_source_settings(Settings& settings, PairSourceOptions& input) {
  const auto path = [&](std::string name, std::string& field, std::string value_name,
                        std::string help) {
    // The journal identifies inputs by their content.
    settings.input_path(std::move(name), field, std::move(value_name), std::move(help))
        .changes_results = false;
  };
  path("left", input.left, "SOURCE",
       "Left frames: a folder, pattern (left/%06d.png), glob, video or stream");
  path("right", input.right, "SOURCE", "Right frames");
  settings.integer("offset", input.offset_frames, "N",
                   "Pair left frame i with right frame i + N, counted from the first of each");
  add_pair_by_setting(settings, input.pair_by);
  path("stereo", input.stereo, "SOURCE",
       "Frames with both images: film, folder or stream (-, tcp://, rtsp://)");
  settings.choice<StereoPacking>(
      "packing", input.packing, stereo_packing_names(),
      "Layout in ffmpeg's stereo3d names: sbsl side by side, abl above/below; auto: the file's");
  add_deinterlace_setting(settings, input.reading);
  add_raw_video_setting(settings, input.raw_video);
  path("pairs", input.pairs, "FILE.csv",
       "List of image files, lines left,right; a heading may name more columns");
  path("sequence", input.sequence, "SOURCE", "Frames of one moving camera; see --step");
  settings.integer("step", input.step, "K",
                   "Frame t is the left image, frame t + K the right image");
  add_frame_step_setting(settings, input.every);
  add_white_level_setting(settings, input.white_level);
  add_reading_settings(settings, input.reading);
}

void add_reading_settings(Settings& settings, PhotographReading& reading) {
  settings.choice<bool>("orientation", reading.turns_upright,
                        {{"upright", true}, {"stored", false}},
                        "Turn images as their EXIF orientation, or the display matrix of a film, "
                        "says; or leave them as they are stored");
  settings.integer("band", reading.band, "N",
                   "Read band N, counted from 1, of images of several; auto: grey or RGB, of other "
                   "bands their mean");
}

void add_pair_by_setting(Settings& settings, std::optional<PairBy>& pair_by) {
  settings.choice<PairBy>("pair-by", pair_by, pair_by_names(),
                          "What tells which frames of two folders or films belong together: their "
                          "names (numbers, stems, time stamps within half a frame), times of films "
                          "or time stamps, or their order. A frame without a partner is left out. "
                          "auto: name, of films time; order where these tell nothing and the "
                          "numbers of frames agree");
}

void add_deinterlace_setting(Settings& settings, PhotographReading& reading) {
  settings.flag("deinterlace", reading.deinterlaces,
                "Make whole pictures of the fields of interlaced films (FFmpeg's bwdif)");
}

void add_white_level_setting(Settings& settings, std::optional<double>& white_level) {
  settings.number(
      "white-level", white_level, "VALUE",
      "Stored value that is white, such as 4095 for 12 bits in 16; auto: what the files state, "
      "else "
      "2^n - 1 of the n bits that 16-bit images use (of floats in another scale than 0 to 1 "
      "likewise), in sequences of up to 8 pairs");
}

}  // namespace vantage
