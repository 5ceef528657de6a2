#include "apps/scene/wanted_scene_views.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "apps/scene/scene_images.h"
#include "apps/settings/toml_file.h"
#include "engine/error.h"
#include "engine/options/wanted_views.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage::apps {
namespace {

ImageSweep to_image_sweep(const SettingValue& value) {
  const std::string expected = fmt::format(
      "FIRST:LAST:VIEWS with numbers of images and 2 to {} views, such as 0:3:50", kMaxViews);
  return from_parts(value, ':', 3, expected, [](const auto& parts) {
    const ImageSweep sweep{to_integer(parts[0]), to_integer(parts[1]), to_integer(parts[2])};
    return is_view_count(sweep.views) ? std::optional(sweep) : std::nullopt;
  });
}

BetweenImages to_between(const SettingValue& value) {
  constexpr const char* kExpected =
      "A:B:SHARE with numbers of images and a share from 0 to 1, such as 0:3:0.5";
  return from_parts(value, ':', 3, kExpected, [](const auto& parts) {
    const BetweenImages between{to_integer(parts[0]), to_integer(parts[1]), to_number(parts[2])};
    return between.share >= 0 && between.share <= 1 ? std::optional(between) : std::nullopt;
  });
}

std::string text_of(ScenePosition position) { return fmt::format("{},{}", position.x, position.y); }

SceneSweep to_scene_sweep(const SettingValue& value) {
  const std::string expected =
      fmt::format("X0,Y0:X1,Y1:VIEWS with 2 to {} views, such as 0,0:2,1:50", kMaxViews);
  return from_parts(value, ':', 3, expected, [](const auto& parts) {
    const SceneSweep sweep{to_scene_position(parts[0]), to_scene_position(parts[1]),
                           to_integer(parts[2])};
    return is_view_count(sweep.views) ? std::optional(sweep) : std::nullopt;
  });
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
  for (const ViewPose& pose : poses_of(path, read_toml_document)) {
    const auto* position = std::get_if<BaselinePosition>(&pose);
    if (position == nullptr) {
      throw UsageError(
          fmt::format("{}: holds cameras, expected positions at = [X, Y] among the images", file));
    }
    positions.push_back({position->x, position->y});
  }
  return positions;
}

PosedCamera camera_between(const BetweenImages& view, const std::vector<PosedCamera>& images) {
  for (const int number : {view.first, view.second}) {
    if (number < 0 || number >= static_cast<int>(images.size())) {
      throw UsageError(
          fmt::format("a view is between images {} and {}, expected numbers from 0 to "
                      "{}",
                      view.first, view.second, images.size() - 1));
    }
  }
  return std::get<PosedCamera>(pose_between(images[static_cast<std::size_t>(view.first)],
                                            images[static_cast<std::size_t>(view.second)],
                                            view.share));
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
      settings.add("sweep", "A:B:N",
                   "N views in equal steps from position A to position B; of a scene with poses, "
                   "from image A to image B, by their numbers");
  sweep.set = [&wanted](const SettingValue& value) {
    const std::string text = value.is_string() ? value.get<std::string>() : "";
    const auto parts = split(text, ':');
    const bool has_positions = text.find(',') != std::string::npos;
    wanted.sweep.reset();
    wanted.image_sweep.reset();
    if (parts.size() == 3 && !has_positions) {
      wanted.image_sweep = to_image_sweep(value);
    } else {
      wanted.sweep = to_scene_sweep(value);
    }
  };
  sweep.get = [&wanted]() -> SettingValue {
    if (wanted.image_sweep) {
      return fmt::format("{}:{}:{}", wanted.image_sweep->first, wanted.image_sweep->last,
                         wanted.image_sweep->views);
    }
    return wanted.sweep
               ? SettingValue(fmt::format("{}:{}:{}", text_of(wanted.sweep->first),
                                          text_of(wanted.sweep->last), wanted.sweep->views))
               : SettingValue();
  };
  settings.input_path(
      "path", wanted.path_file, "FILE",
      "TOML or JSON file of positions, of a scene with poses of cameras, each with a frame number: "
      "one view that moves along them");
  settings.input_path("pose", wanted.pose_file, "FILE",
                      "Of a scene with poses: TOML or JSON file of cameras by K, R and t, with "
                      "x_camera = R x_world + t, one view each");
  Setting& between =
      settings.add("between", "A:B:SHARE",
                   "Of a scene with poses: view on the way from image A (share 0) to image B (1), "
                   "by their numbers; repeatable");
  between.list = true;
  between.set = [&wanted](const SettingValue& value) {
    std::vector<BetweenImages> views;
    for (const SettingValue& member : to_list(value)) {
      views.push_back(to_between(member));
    }
    wanted.between = std::move(views);
  };
  between.get = [&wanted] {
    SettingValue values = SettingValue::array();
    for (const BetweenImages& view : wanted.between) {
      values.push_back(fmt::format("{}:{}:{}", view.first, view.second, view.share));
    }
    return values;
  };
}

std::vector<ScenePosition> scene_positions_of(const WantedSceneViews& wanted) {
  if (!wanted.between.empty() || wanted.image_sweep || !wanted.pose_file.empty()) {
    throw UsageError(
        "views are given by images or cameras, expected --at, --sweep X,Y:X,Y:N or --path: the "
        "scene has positions, not poses");
  }
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

std::vector<PosedCamera> scene_cameras_of(const WantedSceneViews& wanted,
                                          const std::vector<PosedCamera>& images) {
  if (!wanted.at.empty() || wanted.sweep) {
    throw UsageError(
        "views are given by positions, expected --between, --sweep A:B:N with numbers of images, "
        "--pose or --path: the scene has poses");
  }
  const int ways = (wanted.between.empty() ? 0 : 1) + (wanted.image_sweep ? 1 : 0) +
                   (wanted.pose_file.empty() ? 0 : 1) + (wanted.path_file.empty() ? 0 : 1);
  if (ways != 1) {
    throw UsageError(
        fmt::format("{}, expected one of --between, --sweep, --pose and --path",
                    ways == 0 ? "no view is given" : "views are given in several ways"));
  }
  std::vector<PosedCamera> cameras;
  if (wanted.image_sweep) {
    const ImageSweep& sweep = *wanted.image_sweep;
    for (int i = 0; i < sweep.views; ++i) {
      cameras.push_back(camera_between(
          {sweep.first, sweep.last, static_cast<double>(i) / (sweep.views - 1)}, images));
    }
    return cameras;
  }
  for (const BetweenImages& view : wanted.between) {
    cameras.push_back(camera_between(view, images));
  }
  if (!wanted.between.empty()) {
    return cameras;
  }
  const std::string& file = wanted.pose_file.empty() ? wanted.path_file : wanted.pose_file;
  WantedViews listed;
  (wanted.pose_file.empty() ? listed.path : listed.poses).file = file;
  for (const ViewPose& pose : poses_of(listed, read_toml_document)) {
    const auto* camera = std::get_if<PosedCamera>(&pose);
    if (camera == nullptr) {
      throw UsageError(fmt::format(
          "{}: holds positions, expected cameras by K, R and t: the scene has poses", file));
    }
    cameras.push_back(*camera);
    if (camera->width_px == 0) {
      cameras.back().width_px = images.front().width_px;
      cameras.back().height_px = images.front().height_px;
    }
  }
  return cameras;
}

}  // namespace vantage::apps
