#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/view_geometry/view_pose.h"

namespace vantage::apps {

/// One entry of a file of poses.
struct PoseEntry {
  std::optional<int> frame;  ///< of a path: when the view is there
  ViewPose pose;             ///< cameras without a size of their own have 0×0
};

/// Reads poses of new views from TOML (`[[view]]` tables) or, if the name ends in .json, JSON
/// (`{"view": [{…}]}`). An entry is either a position on the baseline, `at = [XS, YS]`, or a
/// camera: `K` and `R` as rows of three (or nine numbers row by row) and `t`, with x_camera = R ·
/// x_left + t in the frame of the rectified left camera and the unit of the calibration; optionally
/// `size = [WIDTH, HEIGHT]`, and `frame` in a path. At least one entry.
/// Throws Error when the file cannot be read, UsageError naming file, entry and key otherwise.
std::vector<PoseEntry> read_poses(const std::string& path);

}  // namespace vantage::apps
