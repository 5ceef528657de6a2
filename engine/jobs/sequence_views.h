#pragma once

#include <optional>
#include <vector>

#include "engine/options/pose_file.h"
#include "engine/options/settings.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage {

/// Which new views a user wants of every frame of a sequence: all of these.
struct SequenceViews {
  std::vector<BaselinePosition> fixed;
  std::vector<ViewPath> moving;  ///< along positions
  PoseList poses;                ///< a view for every pose
  PoseList path;                 ///< one view along these poses
};

/// --view, --view-path, --look-at, --pose and --path, in the group that has begun.
void add_sequence_view_settings(Settings& settings, SequenceViews& views,
                                std::optional<double>& look_at_px);

/// Reads what files name. Throws Error and UsageError as read_poses().
void read_pose_files(SequenceViews& views, const DocumentReader& read_toml);

/// The views in this order. Poses of files must have been read. Throws UsageError where one has a
/// frame too many or too few.
std::vector<ViewPath> paths_of(const SequenceViews& views);

/// Throws UsageError where options of views, `paths` what they come to, do not go together.
void check_views(const SequenceViews& views, const std::vector<ViewPath>& paths,
                 std::optional<double> look_at_px, bool is_calibrated);

}  // namespace vantage
