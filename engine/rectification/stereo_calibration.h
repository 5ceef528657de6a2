#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/side.h"
#include "engine/rectification/camera.h"
#include "engine/rectification/camera_pose.h"
#include "engine/rectification/kitti_cameras.h"
#include "engine/remark.h"

namespace vantage {

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
};

/// A lens and the size of its images.
struct SizedCamera {
  Camera camera;
  ImageSize size;                    ///< 0×0 if the file does not tell
  std::vector<Remark> remarks = {};  ///< what was assumed when it was read

  /// The camera of the same pictures at another size. Empty where that cannot be: the file does not
  /// tell its size, the ratios of the sides do not agree to a pixel, or the sizes differ by less
  /// than a tenth, as those of cropped pictures do.
  [[nodiscard]] std::optional<Camera> scaled_to(ImageSize other) const;
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
  /// The body that carries the cameras (IMU), in the left camera's frame, if the file tells.
  std::optional<CameraPose> left_from_body = std::nullopt;
  std::vector<Remark> remarks = {};  ///< what was assumed when it was read or scaled

  /// Distance of the cameras, in the calibration's unit.
  [[nodiscard]] double baseline() const { return translation.norm(); }
  /// Gives the baseline a length, in metres, which are then the calibration's unit.
  void set_baseline_m(double metres);
  /// cx of the right camera − cx of the left one. In a rectified pair the disparity at infinity is
  /// −doffs_px(): Z = fx · baseline / (d + doffs_px()).
  [[nodiscard]] double doffs_px() const { return right.matrix(0, 2) - left.matrix(0, 2); }

  /// The calibration of images of this size: a scaled one, with a remark, where the file is for
  /// another size of the same shape (SizedCamera::scaled_to()); else itself.
  [[nodiscard]] StereoCalibration for_images(int width_px, int height_px) const;

  /// Throws Error of one line that names the quantity, its value and its limit.
  void validate() const;
  /// Throws Error when images of this size cannot come from these cameras: size other than the
  /// calibration's, principal points outside, or focal lengths below a twentieth of a side (84
  /// degrees off the optical axis).
  void check_image_size(int width_px, int height_px) const;
};

/// What a file does not tell, or not always.
struct CalibrationChoice {
  std::optional<KittiCameras> kitti_cameras = {};  ///< of a file of KITTI; empty: the grey ones
  std::optional<LensKind> lens = {};               ///< of four coefficients whose kind no key names
};

/// The files that the name of a calibration means: itself; or two, separated by a comma, unless
/// there is a file of that name (the second one may be in the folder of the first); or itself and
/// the one of the other camera, where that lies beside it and the file is of one camera (left.yaml
/// and right.yaml, cam0/sensor.yaml and cam1/sensor.yaml). A file that does not exist is among
/// them.
std::vector<std::filesystem::path> calibration_files(const std::filesystem::path& name);

/// Reads a calibration; its content, not its name, decides the format. The Guide lists them:
/// OpenCV's YAML, XML and JSON under many names (rectification/calibration/names), files
/// of ROS, Kalibr, EuRoC and ORB-SLAM, Middlebury and ETH3D, KITTI and DrivingStereo, COLMAP.
/// `path` may name two files (calibration_files()). Cameras that a file numbers are put in order:
/// the right one is to the right. Rectified if the cameras are equal up to cx, without distortion,
/// and displaced along x only. The result is valid; what was assumed is among its remarks. Throws
/// Error of one line naming the file for anything it cannot read. Thread rule: may be called
/// concurrently.
StereoCalibration read_stereo_calibration(const std::filesystem::path& path,
                                          const CalibrationChoice& choice = {});

/// The rectified cameras of OpenCV's matrix Q: (X, Y, Z, 1) ~ Q · (x, y, d, 1), with the rows
/// (1 0 0 -cx), (0 a 0 -a·cy), (0 0 0 f), (0 0 1/B doffs/B); a is 1 in Q of OpenCV, else fx / fy.
/// Throws Error for another one.
StereoCalibration calibration_of_depth_matrix(const Eigen::Matrix4d& q);

/// read_stereo_calibration() for images that were rectified with the calibration of a file: of a
/// file with P1 and P2, or with Q, the cameras of the rectified images, although it has M1 and M2
/// too.
StereoCalibration read_rectified_calibration(const std::filesystem::path& path,
                                             const CalibrationChoice& choice = {});

}  // namespace vantage
