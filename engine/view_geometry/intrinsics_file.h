#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/rectification/camera_pose.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// What a file of intrinsics may not tell.
struct IntrinsicsChoice {
  int kitti_camera = 0;                         ///< of a file of KITTI's, 0 to 3
  std::optional<LensKind> lens = std::nullopt;  ///< of four coefficients
};

/// Parses the intrinsics of one camera; the content tells the format:
///  - YAML, XML and JSON of OpenCV, ROS and others: the names of rectification/calibration/names,
///  without a camera's number or with that of the first one.
///  - COLMAP's cameras.txt with one camera.
///  - KITTI's calib.txt: P0 to P3, or its lines without names: the first if the file lacks the
///  camera that is chosen.
///  - Numbers: fx fy cx cy, or fx fy cx cy k1 k2 p1 p2 [k3].
/// The camera is valid; its size is 0×0 if the file does not tell. Throws Error naming `file`.
/// Thread rule: may be called concurrently.
SizedCamera parse_intrinsics(std::string_view text, const std::string& file,
                             const IntrinsicsChoice& choice = {});
/// parse_intrinsics() of a file. Throws Error, also when it cannot be read.
SizedCamera read_intrinsics(const std::filesystem::path& file, const IntrinsicsChoice& choice = {});

/// Whether a text is OpenCV's YAML or XML with extrinsic_parameters. Throws Error, which names
/// `file`, if it is neither these nor JSON.
bool has_opencv_poses(std::string_view text, const std::string& file);
/// Parses the poses that OpenCV's calibration writes: extrinsic_parameters, N×6, rows rx ry rz tx
/// ty tz (rotation vector, translation), world to camera. Throws Error naming `file`.
std::vector<CameraPose> parse_opencv_poses(std::string_view text, const std::string& file);

}  // namespace vantage
