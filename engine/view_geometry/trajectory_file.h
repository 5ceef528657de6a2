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
  std::string format;             ///< "TUM", "KITTI", "EuRoC" or "NeRF"
  std::vector<CameraPose> poses;  ///< at least one
  std::vector<double> times_s;    ///< of the poses; empty if the file has none (KITTI)
  bool is_of_body = false;        ///< the poses are those of the body (IMU), not of a camera: EuRoC

  /// The poses of a camera on that body; `camera_from_body` is the body in its frame.
  [[nodiscard]] Trajectory of_camera(const CameraPose& camera_from_body) const;
};

/// Parses a trajectory. The count of numbers per line tells the format; all hold camera to world:
///  - TUM: time tx ty tz qx qy qz qw.
///  - EuRoC: 17 columns, time tx ty tz qw qx qy qz and nine more; or 8, with commas and a time in
///  nanoseconds (other data sets of that format). Body to world.
///  - NeRF's transforms.json: the poses of its images, sorted by name.
///  - KITTI: 12 numbers, the rows of a 3×4 matrix, or 16 with a last row 0 0 0 1.
/// Times from 1e14 are nanoseconds, else seconds. Numbers are separated by blanks or commas; blank
/// lines and comments (#) are skipped. Throws Error naming `file` and the line for anything else.
/// Thread rule: may be called concurrently.
Trajectory parse_trajectory(std::string_view text, const std::string& file);

/// parse_trajectory() of a file. Throws Error, also when it cannot be read.
Trajectory read_trajectory(const std::filesystem::path& file);

}  // namespace vantage
