#include "engine/jobs/sequence_views.h"

#include <string>
#include <utility>

#include "engine/error.h"
#include "engine/options/setting_value.h"
#include "engine/options/wanted_views.h"

namespace vantage {
namespace {

void add_view_path_setting(Settings& settings, std::vector<ViewPath>& paths) {
  Setting& setting = settings.add("view-path", "KEYS",
                                  "New view that moves linearly between positions: "
                                  "FRAME=XS,FRAME=XS... or FRAME=XS,YS,...; repeatable");
  setting.list = true;
  setting.set = [&paths](const SettingValue& value) {
    std::vector<ViewPath> read;
    for (const SettingValue& member : to_list(value)) {
      read.push_back(parse_view_path(to_text(member)));
    }
    paths = std::move(read);
  };
  setting.get = [&paths] {
    SettingValue texts = SettingValue::array();
    for (const ViewPath& path : paths) {
      texts.push_back(to_string(path));
    }
    return texts;
  };
}

}  // namespace

void add_sequence_view_settings(Settings& settings, SequenceViews& views,
                                std::optional<double>& look_at_px) {
  add_view_setting(settings, views.fixed);
  add_view_path_setting(settings, views.moving);
  add_pose_settings(settings, "--view and --view-path", look_at_px, views.poses, views.path);
}

void read_pose_files(SequenceViews& views, const DocumentReader& read_toml) {
  for (PoseList* list : {&views.poses, &views.path}) {
    list->entries = entries_of(*list, read_toml);
  }
}

std::vector<ViewPath> paths_of(const SequenceViews& views) {
  std::vector<ViewPath> paths;
  for (const BaselinePosition position : views.fixed) {
    paths.push_back(ViewPath::fixed(position));
  }
  paths.insert(paths.end(), views.moving.begin(), views.moving.end());
  for (const ViewPose& pose : fixed_poses(views.poses)) {
    paths.push_back(ViewPath::fixed(pose));
  }
  if (!views.path.empty()) {
    paths.push_back(path_along(views.path));
  }
  return paths;
}

void check_views(const SequenceViews& views, const std::vector<ViewPath>& paths,
                 std::optional<double> look_at_px, bool is_calibrated) {
  if (look_at_px && (!views.poses.empty() || !views.path.empty())) {
    throw UsageError("--look-at turns the cameras of --view and --view-path only");
  }
  if (look_at_px && paths.empty()) {
    throw UsageError("--look-at has no effect without --view or --view-path");
  }
  if (is_calibrated) {
    return;
  }
  for (const ViewPath& path : paths) {
    require_calibration(path.keys.front().pose, look_at_px);
  }
}

}  // namespace vantage
