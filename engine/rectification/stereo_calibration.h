#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/image/side.h"
#include "engine/rectification/camera.h"
#include "engine/rectification/kitti_cameras.h"

namespace vantage {

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
};

/// A lens and the size of its images.
struct SizedCamera {
  Camera camera;
  ImageSize size;  ///< 0×0 if the file does not tell
};

/// Two cameras and their relative pose: x_right = rotation · x_left + translation for a point in
/// the left and right camera's frame.
struct StereoCalibration {
  Camera left = {};
  Camera right = {};
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< R, proper
  /// t, in the calibration's unit (that of the target: often m or mm). The right camera is at −Rᵀ·t
  /// in the left one's frame.
  Eigen::Vector3d translation = Eigen::Vector3d(-1, 0, 0);
  std::optional<ImageSize> image_size = std::nullopt;  ///< of both images, if given in the file
  /// Length of the calibration's unit: 0.001 for millimetres. Empty where the file does not say it.
  std::optional<double> metres_per_unit = std::nullopt;
  /// False: the cameras were estimated from images alone, and their baseline has length 1.
  bool has_scale = true;
  /// The images are rectified: rows of both images correspond.
  bool is_rectified = false;
  std::optional<KittiCameras> kitti_cameras =
      std::nullopt;                    ///< of a file of KITTI: which these are
  bool has_other_cameras = false;      ///< the file has both pairs of KITTI's
  std::string format = "calibration";  ///< for messages: "KITTI, cameras 0 and 1"
  std::string file = {};               ///< for messages: source file, if any

  /// Distance of the cameras, in the calibration's unit.
  [[nodiscard]] double baseline() const { return translation.norm(); }
  /// Gives the baseline a length, in metres, which are then the calibration's unit.
  void set_baseline_m(double metres);
  /// cx of the right camera − cx of the left one. In a rectified pair the disparity at infinity is
  /// −doffs_px(): Z = fx · baseline / (d + doffs_px()).
  [[nodiscard]] double doffs_px() const { return right.matrix(0, 2) - left.matrix(0, 2); }

  /// Throws Error of one line that names the quantity, its value and its limit.
  void validate() const;
  /// Throws Error when images of this size cannot come from these cameras: size other than the
  /// calibration's, principal points outside, or focal lengths below a twentieth of a side (84
  /// degrees off the optical axis).
  void check_image_size(int width_px, int height_px) const;
};

/// Reads a calibration; its content, not its name, decides the format:
///  - OpenCV YAML or XML: matrices M1 or K1 or cameraMatrix1 (3×3), D1 or distCoeffs1 (absent: no
///  distortion), the same with 2, R (3×3) and T (3×1 or 1×3), all in one file; optionally
///  image_width and image_height, or imageSize, or image_size. Rectified if the cameras are equal
///  up to cx, without distortion, and displaced along x only. Without M1, the rectified cameras of
///  P1 and P2 (3×4), or else of Q (4×4). metres_per_unit, if in the file; 0 means no scale.
///  - Middlebury calib.txt: cam0, cam1, baseline, width, height, and doffs, which must agree with
///  the cameras to 0.1 px. Rectified, in millimetres.
///  - KITTI calib.txt: P0 and P1 (grey) or P2 and P3 (colour), or the same under the names
///  P_rect_00 …, or two or four lines of 12 numbers without names. Rectified, in metres. `cameras`
///  selects the pair; empty: the grey one if the file has it. For other formats it must be empty.
/// Fisheye models are refused if the file names them (fisheye_model of OpenCV's samples,
/// distortion_model, camera_model or model); their four coefficients alone look like those of other
/// lenses. The result is valid. Throws Error of one line naming the file for anything it cannot
/// read. Thread rule: may be called concurrently.
StereoCalibration read_stereo_calibration(const std::filesystem::path& path,
                                          std::optional<KittiCameras> cameras = std::nullopt);

/// The rectified cameras of OpenCV's matrix Q: (X, Y, Z, 1) ~ Q · (x, y, d, 1), with the rows
/// (1 0 0 -cx), (0 a 0 -a·cy), (0 0 0 f), (0 0 1/B doffs/B); a is 1 in Q of OpenCV, else fx / fy.
/// Throws Error for another one.
StereoCalibration calibration_of_depth_matrix(const Eigen::Matrix4d& q);

/// read_stereo_calibration() for images that were rectified with the calibration of a file: of an
/// OpenCV file with P1 and P2, or with Q, the cameras of the rectified images, although it has M1
/// and M2 too.
StereoCalibration read_rectified_calibration(const std::filesystem::path& path,
                                             std::optional<KittiCameras> cameras = std::nullopt);

}  // namespace vantage
