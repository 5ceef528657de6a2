#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/scene/poses_job.h"
#include "apps/settings/command_line.h"
#include "engine/options/calibration_settings.h"
#include "engine/options/pair_source_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {
namespace {

void add_known_distance(Settings& settings, std::optional<KnownDistance>& distance) {
  Setting& setting =
      settings.add("known-distance", "I:J:METRES",
                   "Distance of the cameras of images I and J, counted from 0: lengths are then "
                   "metres; auto: the median distance of a camera from the nearest one is 1");
  setting.set = [&distance](const SettingValue& value) {
    if (value == "auto") {
      distance.reset();
      return;
    }
    constexpr const char* kExpected =
        "two different images and a length above 0 such as 0:3:0.25, or auto";
    distance = from_parts(value, ':', 3, kExpected, [](const auto& parts) {
      const KnownDistance given{to_integer(parts[0]), to_integer(parts[1]), to_number(parts[2])};
      const bool is_valid = given.first >= 0 && given.second >= 0 && given.first != given.second &&
                            given.metres > 0 && std::isfinite(given.metres);
      return is_valid ? std::optional(given) : std::nullopt;
    });
  };
  setting.get = [&distance]() -> SettingValue {
    return distance ? fmt::format("{}:{}:{}", distance->first, distance->second, distance->metres)
                    : std::string("auto");
  };
}

void add_scene_poses_settings(Settings& settings, ScenePosesJob& job) {
  settings.start_group("Files");
  settings.input_path("images", job.images, "SOURCE",
                      "Photographs of one lens and one size: a folder, a pattern "
                      "(images/%03d.png) or a glob");
  settings.input_path(
      "intrinsics", job.intrinsics, "FILE",
      "Camera: OpenCV's YAML or XML, COLMAP's cameras.txt, KITTI's calib.txt (P2 for "
      "images in image_2, else P0), or a text fx fy cx cy [k1 k2 p1 p2 [k3]]; none: focal length "
      "and radial "
      "distortion are estimated");
  add_lens_setting(settings, job.lens);
  add_reading_settings(settings, job.reading);
  Setting& output =
      settings.path("output", job.output, "MODEL", "Folder of the poses, a COLMAP model as text");
  output.short_name = 'o';
  output.required = true;
  add_overwrite_setting(settings, job.overwrite);
  settings.start_group("Estimation");
  add_known_distance(settings, job.distance);
  settings.integer("partners", job.estimation.partners, "N",
                   "Images that each image is matched with at most, those that look most alike, 1 "
                   "to 100");
  add_common_settings(settings, job.common, Work::kWithoutMatching);
  add_input_limit_settings(settings, job.common.execution);
  settings.set_short_help(
      {"images", "intrinsics", "output", "known-distance", "partners", "threads", "quiet"},
      {"vantage scene poses --images photographs/ -o model",
       "vantage scene poses --images photographs/ --known-distance 0:1:0.25 -o model",
       "vantage scene build --poses model --images photographs/ -o scene"});
}

}  // namespace

int command_scene_poses(const Arguments& arguments) {
  ScenePosesJob job;
  Settings settings("scene poses",
                    "Estimates where the cameras of hand-held photographs stood, for 'scene build "
                    "--poses'.");
  add_scene_poses_settings(settings, job);
  return read_command_line(settings, arguments) ? estimate_poses(job, settings) : kExitDone;
}

}  // namespace vantage::apps
