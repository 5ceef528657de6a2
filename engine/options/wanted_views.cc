#include "engine/options/wanted_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "engine/error.h"

namespace vantage {
namespace {

Sweep to_sweep(const SettingValue& value) {
  const std::string expected = fmt::format(
      "FIRST:LAST:VIEWS with 2 to {} views, such as 0:1:25 or 0,-0.5:0,0.5:25", kMaxViews);
  return from_parts(value, ':', 3, expected, [](const auto& parts) {
    const Sweep sweep{to_position(parts[0]), to_position(parts[1]), to_integer(parts[2])};
    return is_view_count(sweep.views) ? std::optional(sweep) : std::nullopt;
  });
}

Orbit to_orbit(const SettingValue& value) {
  const std::string expected = fmt::format(
      "RADIUS:VIEWS with a radius of up to {} baselines and 2 to {} views, such as 0.3:60",
      kMaxViewDistance, kMaxViews);
  return from_parts(value, ':', 2, expected, [](const auto& parts) {
    const Orbit orbit{to_number(parts[0]), to_integer(parts[1])};
    const bool is_near = orbit.radius_baselines > 0 && orbit.radius_baselines <= kMaxViewDistance;
    return is_near && is_view_count(orbit.views) ? std::optional(orbit) : std::nullopt;
  });
}

std::vector<ViewPose> poses_of_path(const PoseList& list, const DocumentReader& read_toml) {
  const ViewPath path = path_along({list.file, entries_of(list, read_toml)});
  if (path.frames() > kMaxViews) {
    throw UsageError(fmt::format("{}: path has {} frames, expected at most {}", list.name(),
                                 path.frames(), kMaxViews));
  }
  std::vector<ViewPose> poses;
  for (int frame = 0; frame < path.frames(); ++frame) {
    poses.push_back(path.at(frame));
  }
  return poses;
}

std::vector<ViewPose> poses_of_sweep(const Sweep& sweep) {
  std::vector<ViewPose> poses;
  for (int i = 0; i < sweep.views; ++i) {
    poses.push_back(
        pose_between(sweep.first, sweep.last, static_cast<double>(i) / (sweep.views - 1)));
  }
  return poses;
}

void add_pose_list(Settings& settings, std::string name, PoseList& list, std::string help) {
  Setting& setting = settings.add(std::move(name), "FILE", std::move(help));
  setting.kind = ValueKind::kPoses;
  setting.path = PathRole::kInput;
  // Results depend on the content of the file, not on its name.
  setting.changes_results = false;
  setting.set = [&list](const SettingValue& value) {
    list = value.is_array() ? PoseList{"", poses_in(value, PoseList().name())}
                            : PoseList{to_text(value), {}};
  };
  setting.get = [&list]() -> SettingValue {
    return list.empty()        ? SettingValue()
           : list.file.empty() ? to_value(list.entries)
                               : SettingValue(list.file);
  };
}

}  // namespace

bool is_view_count(int views) { return views >= 2 && views <= kMaxViews; }

BaselinePosition to_position(const SettingValue& value) {
  std::vector<std::string> parts;
  try {
    if (!value.is_string()) {
      const double x = to_number(value);
      return {x, 0};
    }
    parts = split(value.get<std::string>(), ',');
    if (parts.size() <= 2) {
      const BaselinePosition position{to_number(parts[0]),
                                      parts.size() == 2 ? to_number(parts[1]) : 0};
      if (std::abs(position.x) <= kMaxViewDistance && std::abs(position.y) <= kMaxViewDistance) {
        return position;
      }
    }
  } catch (const UsageError&) {  // the message below says more
  }
  reject_value(value, fmt::format("a position XS or XS,YS in baselines, within ±{}, such as 0.5",
                                  kMaxViewDistance));
}

void add_view_setting(Settings& settings, std::vector<BaselinePosition>& views) {
  Setting& view = settings.add("view", "XS[,YS]",
                               "Position of a new view in baselines: 0 left camera, 1 right "
                               "camera; YS is positive downwards; repeatable");
  view.kind = ValueKind::kNumberOrText;
  view.list = true;
  view.set = [&views](const SettingValue& value) {
    std::vector<BaselinePosition> positions;
    for (const SettingValue& member : to_list(value)) {
      positions.push_back(to_position(member));
    }
    views = std::move(positions);
  };
  view.get = [&views] {
    SettingValue values = SettingValue::array();
    for (const BaselinePosition position : views) {
      values.push_back(position.y == 0 ? SettingValue(position.x)
                                       : SettingValue(to_string(position)));
    }
    return values;
  };
}

void add_pose_settings(Settings& settings, const std::string& turned,
                       std::optional<double>& look_at_px, PoseList& poses, PoseList& path) {
  settings.number(
      "look-at", look_at_px, "PX",
      fmt::format(
          "Turn the cameras of {} towards the central point at disparity PX; needs --calibration",
          turned),
      "ahead");
  add_pose_list(settings, "pose", poses,
                "TOML or JSON file of poses, one view each: positions, or cameras by K, R and t, "
                "which need --calibration");
  add_pose_list(
      settings, "path", path,
      "File of poses as for --pose, each with a frame number: one view that moves along them");
}

void add_wanted_views(Settings& settings, WantedViews& wanted) {
  add_view_setting(settings, wanted.at);
  Setting& sweep =
      settings.add("sweep", "A:B:N", "N views in equal steps from position A to position B");
  sweep.set = [&wanted](const SettingValue& value) { wanted.sweep = to_sweep(value); };
  sweep.get = [&wanted]() -> SettingValue {
    return wanted.sweep
               ? SettingValue(fmt::format("{}:{}:{}", to_string(wanted.sweep->first),
                                          to_string(wanted.sweep->last), wanted.sweep->views))
               : SettingValue();
  };
  Setting& orbit = settings.add(
      "orbit", "R:N",
      "N views on a circle with a radius of R baselines around the midpoint of the cameras");
  orbit.set = [&wanted](const SettingValue& value) { wanted.orbit = to_orbit(value); };
  orbit.get = [&wanted]() -> SettingValue {
    return wanted.orbit ? SettingValue(fmt::format("{}:{}", wanted.orbit->radius_baselines,
                                                   wanted.orbit->views))
                        : SettingValue();
  };
  add_pose_settings(settings, "--view, --sweep or --orbit", wanted.look_at_px, wanted.poses,
                    wanted.path);
}

std::vector<ViewPose> poses_of(const WantedViews& wanted, const DocumentReader& read_toml) {
  const int ways = (wanted.at.empty() ? 0 : 1) + (wanted.sweep ? 1 : 0) + (wanted.orbit ? 1 : 0) +
                   (wanted.poses.empty() ? 0 : 1) + (wanted.path.empty() ? 0 : 1);
  if (ways != 1) {
    throw UsageError(
        fmt::format("{}, expected one of --view, --sweep, --orbit, --pose and --path",
                    ways == 0 ? "no view is given" : "views are given in several ways"));
  }
  if (wanted.look_at_px && (!wanted.poses.empty() || !wanted.path.empty())) {
    throw UsageError("--look-at turns the cameras of --view, --sweep and --orbit only");
  }
  if (wanted.sweep) {
    return poses_of_sweep(*wanted.sweep);
  }
  if (!wanted.poses.empty()) {
    return fixed_poses({wanted.poses.file, entries_of(wanted.poses, read_toml)});
  }
  if (!wanted.path.empty()) {
    return poses_of_path(wanted.path, read_toml);
  }
  const std::vector<BaselinePosition> positions =
      wanted.orbit ? orbit(wanted.orbit->radius_baselines, wanted.orbit->views) : wanted.at;
  return {positions.begin(), positions.end()};
}

std::vector<ViewPose> fixed_poses(const PoseList& list) {
  std::vector<ViewPose> poses;
  for (const PoseEntry& entry : list.entries) {
    if (entry.frame) {
      throw UsageError(fmt::format("{}: view {} has a frame, which only --path uses; expected none",
                                   list.name(), poses.size() + 1));
    }
    poses.push_back(entry.pose);
  }
  return poses;
}

ViewPath path_along(const PoseList& list) {
  ViewPath path;
  for (const PoseEntry& entry : list.entries) {
    if (!entry.frame) {
      throw UsageError(
          fmt::format("{}: view {} has no frame, expected one for every pose of a path",
                      list.name(), path.keys.size() + 1));
    }
    path.keys.push_back({*entry.frame, entry.pose});
  }
  try {
    path.validate();
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", list.name(), error.what()));
  }
  return path;
}

void require_calibration(const ViewPose& pose, std::optional<double> look_at_px) {
  if (look_at_px) {
    throw UsageError("--look-at needs the focal length, expected --calibration");
  }
  if (std::holds_alternative<PosedCamera>(pose)) {
    throw UsageError("poses with K, R and t need calibrated cameras, expected --calibration");
  }
}

void complete_poses(const WantedViews& wanted, const RectifiedPair* pair, int width_px,
                    int height_px, std::vector<ViewPose>& poses) {
  for (ViewPose& pose : poses) {
    if (pair == nullptr) {
      require_calibration(pose, wanted.look_at_px);
    }
    pose = placed(pose, wanted.look_at_px, pair, width_px, height_px);
  }
}

}  // namespace vantage
