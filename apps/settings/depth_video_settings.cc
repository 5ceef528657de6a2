#include "apps/settings/depth_video_settings.h"

#include <fmt/format.h>

#include <string>

#include "engine/error.h"

namespace vantage::apps {
namespace {

void add_depth_range_setting(Settings& settings, DepthVideoScale& scale) {
  Setting& setting = settings.add(
      "depth-range", "film|shot|MIN:MAX",
      "Disparities that black and white of the depth video stand for: those searched in the film, "
      "in each shot, or these, in pixels");
  setting.set = [&scale](const SettingValue& value) {
    const std::string text = to_text(value);
    if (text == "film" || text == "shot") {
      scale = {text == "film" ? DepthVideoScale::Scope::kFilm : DepthVideoScale::Scope::kShot, {}};
      return;
    }
    const auto parts = split(text, ':');
    try {
      if (parts.size() == 2) {
        scale = {
            DepthVideoScale::Scope::kGiven,
            {static_cast<float>(to_number(parts[0])), static_cast<float>(to_number(parts[1]))}};
        return;
      }
    } catch (const UsageError&) {
      // reported below
    }
    reject_value(value, "film, shot, or two disparities such as -20:35");
  };
  setting.get = [&scale]() -> SettingValue {
    return scale.scope == DepthVideoScale::Scope::kFilm ? "film"
           : scale.scope == DepthVideoScale::Scope::kShot
               ? "shot"
               : fmt::format("{}:{}", scale.given.min_px, scale.given.max_px);
  };
}

}  // namespace

void add_depth_video_settings(Settings& settings, DepthVideoScale& scale, VideoCoding& coding) {
  add_depth_range_setting(settings, scale);
  settings.choice<VideoCoding>(
      "depth-codec", coding, grey_coding_names(),
      "Codec of the depth video, and its bits per pixel: ffvhuff (fast) and "
      "FFV1 (smaller) are lossless (.mkv); HEVC (.mp4) and ProRes (.mov) where FFmpeg has them");
}

}  // namespace vantage::apps
