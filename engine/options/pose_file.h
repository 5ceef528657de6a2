#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/options/setting_value.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage {

/// One entry of a file of poses.
struct PoseEntry {
  std::optional<int> frame;  ///< frame number; only in a path
  ViewPose pose;             ///< cameras without a size of their own have 0×0
};

/// Poses that a user names by a file, or that have been read already.
struct PoseList {
  std::string file;
  std::vector<PoseEntry> entries;

  [[nodiscard]] bool empty() const { return file.empty() && entries.empty(); }
  /// For messages.
  [[nodiscard]] std::string name() const { return file.empty() ? "list of poses" : file; }
};

/// Reads a TOML file as a value: programs bring the library that they have. Throws as read_poses().
using DocumentReader = std::function<SettingValue(const std::string& path)>;

/// Reads poses of new views from TOML (`[[view]]` tables) or, if the name ends in .json, JSON
/// (`{"view": [{…}]}`). An entry is either a position on the baseline, `at = [XS, YS]`, or a
/// camera: `K` and `R` as rows of three (or nine numbers row by row) and `t`, with x_camera = R ·
/// x_left + t in the frame of the rectified left camera and the unit of the calibration; optionally
/// `size = [WIDTH, HEIGHT]`, and `frame` in a path. At least one entry.
/// Throws Error when the file cannot be read, UsageError naming file, entry and key otherwise.
std::vector<PoseEntry> read_poses(const std::string& path, const DocumentReader& read_toml);

/// Reads a list of such entries; messages call it `name`.
std::vector<PoseEntry> poses_in(const SettingValue& list, const std::string& name);
/// Converts poses to such a list; poses_in() restores them bit for bit.
SettingValue to_value(const std::vector<PoseEntry>& poses);

/// Reads the poses of the files that are named.
std::vector<PoseEntry> entries_of(const PoseList& list, const DocumentReader& read_toml);

}  // namespace vantage
