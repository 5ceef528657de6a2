#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/rectification/camera_pose.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// Parses the intrinsics of one camera; the content tells the format:
///  - OpenCV YAML or XML, and camera_info of ROS: camera_matrix, K, cameraMatrix or K1, M1, …
///  (3×3); distortion_coefficients, distCoeffs or D (absent: none); image_width and image_height,
///  or image_size.
///  - COLMAP's cameras.txt with one camera.
///  - KITTI's calib.txt: P0 to P3, or its lines without names: that of `kitti_camera`, 0 to 3, or
///  the first if the file lacks it.
///  - Numbers: fx fy cx cy, or fx fy cx cy k1 k2 p1 p2 [k3].
/// The camera is valid; its size is 0×0 if the file does not tell. Fisheye models are refused.
/// Throws Error naming `file`. Thread rule: may be called concurrently.
SizedCamera parse_intrinsics(std::string_view text, const std::string& file, int kitti_camera = 0);
/// parse_intrinsics() of a file. Throws Error, also when it cannot be read.
SizedCamera read_intrinsics(const std::filesystem::path& file, int kitti_camera = 0);

/// Whether a text is OpenCV's YAML or XML with extrinsic_parameters.
bool has_opencv_poses(std::string_view text);
/// Parses the poses that OpenCV's calibration writes: extrinsic_parameters, N×6, rows rx ry rz tx
/// ty tz (rotation vector, translation), world to camera. Throws Error naming `file`.
std::vector<CameraPose> parse_opencv_poses(std::string_view text, const std::string& file);

}  // namespace vantage
