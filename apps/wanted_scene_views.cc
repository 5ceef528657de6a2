#include "apps/wanted_scene_views.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "apps/scene_images.h"
#include "apps/wanted_views.h"
#include "engine/error.h"

namespace vantage::apps {
namespace {

constexpr int kMaxSceneViews = 10000;

std::string text_of(ScenePosition position) { return fmt::format("{},{}", position.x, position.y); }

SceneSweep to_scene_sweep(const SettingValue& value) {
  const auto parts = split(value.is_string() ? value.get<std::string>() : "", ':');
  try {
    if (parts.size() == 3) {
      const SceneSweep sweep{to_scene_position(parts[0]), to_scene_position(parts[1]),
                             to_integer(parts[2])};
      if (sweep.views >= 2 && sweep.views <= kMaxSceneViews) {
        return sweep;
      }
    }
  } catch (const UsageError&) {  // the message below says more
  }
  reject_value(value, fmt::format("X0,Y0:X1,Y1:VIEWS with 2 to {} views, such as 0,0:2,1:50",
                                  kMaxSceneViews));
}

std::vector<ScenePosition> positions_of(const SceneSweep& sweep) {
  std::vector<ScenePosition> positions;
  for (int i = 0; i < sweep.views; ++i) {
    const double t = static_cast<double>(i) / (sweep.views - 1);
    const auto between = [&](double first, double last) { return (1 - t) * first + t * last; };
    positions.push_back(
        {between(sweep.first.x, sweep.last.x), between(sweep.first.y, sweep.last.y)});
  }
  return positions;
}

std::vector<ScenePosition> positions_of_path(const std::string& file) {
  WantedViews path;
  path.path.file = file;
  std::vector<ScenePosition> positions;
  for (const ViewPose& pose : poses_of(path)) {
    const auto* position = std::get_if<BaselinePosition>(&pose);
    if (position == nullptr) {
      throw UsageError(
          fmt::format("{}: holds cameras, expected positions at = [X, Y] among the images", file));
    }
    positions.push_back({position->x, position->y});
  }
  return positions;
}

}  // namespace

void add_wanted_scene_views(Settings& settings, WantedSceneViews& wanted) {
  Setting& at = settings.add("at", "X,Y",
                             "Position of a new view, in the unit of the image positions; at most "
                             "16 lengths of the nearest edge outside; repeatable");
  at.list = true;
  at.set = [&wanted](const SettingValue& value) {
    std::vector<ScenePosition> positions;
    for (const SettingValue& member : to_list(value)) {
      positions.push_back(to_scene_position(member));
    }
    wanted.at = std::move(positions);
  };
  at.get = [&wanted] {
    SettingValue values = SettingValue::array();
    for (const ScenePosition position : wanted.at) {
      values.push_back(text_of(position));
    }
    return values;
  };
  Setting& sweep =
      settings.add("sweep", "A:B:N", "N views in equal steps from position A to position B");
  sweep.set = [&wanted](const SettingValue& value) { wanted.sweep = to_scene_sweep(value); };
  sweep.get = [&wanted]() -> SettingValue {
    return wanted.sweep
               ? SettingValue(fmt::format("{}:{}:{}", text_of(wanted.sweep->first),
                                          text_of(wanted.sweep->last), wanted.sweep->views))
               : SettingValue();
  };
  settings.input_path(
      "path", wanted.path_file, "FILE",
      "TOML or JSON file of positions, each with a frame number: one view that moves along them");
}

std::vector<ScenePosition> scene_positions_of(const WantedSceneViews& wanted) {
  const int ways =
      (wanted.at.empty() ? 0 : 1) + (wanted.sweep ? 1 : 0) + (wanted.path_file.empty() ? 0 : 1);
  if (ways != 1) {
    throw UsageError(
        fmt::format("{}, expected one of --at, --sweep and --path",
                    ways == 0 ? "no view is given" : "views are given in several ways"));
  }
  if (wanted.sweep) {
    return positions_of(*wanted.sweep);
  }
  return wanted.path_file.empty() ? wanted.at : positions_of_path(wanted.path_file);
}

}  // namespace vantage::apps
