#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/options/pose_file.h"
#include "engine/options/settings.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage {

inline constexpr int kMaxViews = 10000;

/// Views at equal steps from one position to another, both included.
struct Sweep {
  BaselinePosition first;
  BaselinePosition last;
  int views = 0;
};

/// Views on a circle about the middle between the cameras.
struct Orbit {
  double radius_baselines = 0;
  int views = 0;
};

/// Which new views a user wants: one of the first five.
struct WantedViews {
  std::vector<BaselinePosition> at;
  std::optional<Sweep> sweep;
  std::optional<Orbit> orbit;
  PoseList poses;  ///< a view for every pose
  PoseList path;   ///< a view for every frame between the poses
  std::optional<double> look_at_px;
};

/// Whether a sweep or orbit may have so many views.
bool is_view_count(int views);

/// XS or "XS,YS". Throws UsageError.
BaselinePosition to_position(const SettingValue& value);

/// --view, repeatable.
void add_view_setting(Settings& settings, std::vector<BaselinePosition>& views);
/// --look-at, --pose and --path. `turned` names the options whose views --look-at turns.
void add_pose_settings(Settings& settings, const std::string& turned,
                       std::optional<double>& look_at_px, PoseList& poses, PoseList& path);
/// --view, --sweep, --orbit, --pose, --path and --look-at, in the group that has begun.
void add_wanted_views(Settings& settings, WantedViews& wanted);

/// The poses in order, 1 to 10000, with the files of poses read. Throws UsageError unless exactly
/// one way of naming views is used and goes with the others, Error where a file cannot be read.
std::vector<ViewPose> poses_of(const WantedViews& wanted, const DocumentReader& read_toml);

/// Poses of views that stand still. Throws UsageError where one has a frame.
std::vector<ViewPose> fixed_poses(const PoseList& list);
/// The path along poses, which need frames. Throws UsageError naming the list.
ViewPath path_along(const PoseList& list);

/// Throws UsageError where `pose` needs a calibration: cameras, and positions that are turned.
void require_calibration(const ViewPose& pose, std::optional<double> look_at_px);

/// Turns baseline positions towards `look_at_px` and gives cameras without a size that of the
/// images. `pair`: null without calibration. Throws UsageError where a calibration is needed.
void complete_poses(const WantedViews& wanted, const RectifiedPair* pair, int width_px,
                    int height_px, std::vector<ViewPose>& poses);

}  // namespace vantage
