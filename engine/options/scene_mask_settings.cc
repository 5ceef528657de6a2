#include "engine/options/scene_mask_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>

namespace vantage {

void add_scene_mask_settings(Settings& settings, SceneMaskOptions& masks, bool per_frame) {
  const char* const each =
      per_frame ? ", one picture, or a folder, pattern or video with one for each frame" : "";
  settings.input_path(
      "mask", masks.left, "FILE|alpha|none",
      fmt::format("Mask of the left image{}: black pixels show no scene; they are neither matched "
                  "nor filled, and unknown in all results. alpha: transparent pixels of the "
                  "images; none: all show it. Without masks, black bars of films and black wedges "
                  "of rectified images are found",
                  each));
  settings.input_path("mask-right", masks.right, "FILE", "The same of the right image");
  Setting& no_data =
      settings.add("no-data", "COLOUR",
                   "Pixels of this value, a grey level or R,G,B as stored, show no scene; none: "
                   "there is no such value");
  no_data.kind = ValueKind::kNumbers;
  no_data.words = {"none"};
  no_data.set = [&masks](const SettingValue& value) {
    masks.no_data.clear();
    if (is_word(value, "none")) {
      return;
    }
    for (const SettingValue& member : to_list(value)) {
      for (const std::string& part :
           member.is_string() ? split(to_text(member), ',') : std::vector<std::string>()) {
        masks.no_data.push_back(to_number(part));
      }
      if (member.is_number()) {
        masks.no_data.push_back(member.get<double>());
      }
    }
  };
  no_data.get = [&masks]() -> SettingValue {
    return masks.no_data.empty() ? "none" : fmt::format("{}", fmt::join(masks.no_data, ","));
  };
}

}  // namespace vantage
