#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/rectification/camera_pose.h"

namespace vantage {

/// Poses of one moving camera, in the order of a file.
struct Trajectory {
  std::string format;             ///< "TUM" or "KITTI"
  std::vector<CameraPose> poses;  ///< at least one
  std::vector<double> times_s;    ///< of the poses; empty if the file has none (KITTI)
};

/// Parses a trajectory. The count of numbers per line tells the format; both hold camera to world:
///  - TUM: time tx ty tz qx qy qz qw.
///  - KITTI: 12 numbers, the rows of a 3×4 matrix, or 16 with a last row 0 0 0 1.
/// Numbers are separated by blanks or commas; blank lines and comments (#) are skipped. Throws
/// Error naming `file` and the line for anything else. Thread rule: may be called concurrently.
Trajectory parse_trajectory(std::string_view text, const std::string& file);

/// parse_trajectory() of a file. Throws Error, also when it cannot be read.
Trajectory read_trajectory(const std::filesystem::path& file);

}  // namespace vantage
