#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/rectification/calibration/calibration_names.h"
#include "engine/rectification/camera_pose.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

/// What entries say of one camera.
struct CameraReading {
  std::optional<Eigen::Matrix3d> matrix;
  std::vector<double> distortion;
  std::string distortion_name;   ///< in the file; empty: no distortion
  bool is_column = false;        ///< the distortion is 4×1, as cv2.fisheye writes it
  std::optional<LensKind> lens;  ///< where the file tells
  std::string lens_name;         ///< the key that tells
  std::optional<ImageSize> size;
  std::optional<Eigen::Matrix3d> rectification;
  std::optional<Matrix34> projection;
  std::optional<CameraPose> from_previous;  ///< of the camera before, in this one's frame
  std::optional<CameraPose> from_body;

  /// Without matrix: 0. Needs choose_lenses() before.
  [[nodiscard]] Camera camera() const;
};

/// Throws Error for entries of a wrong size, and for lens models that are not known.
CameraReading read_camera(const CalibrationNames& names, CameraLabel camera);

/// Tells what four coefficients are: by the file, by `wanted`, or by the other camera's. A note is
/// added to `remarks` where that is an assumption. Throws Error where it cannot be told: 4×1 is
/// what cv2.fisheye writes, and old programs of the standard model too.
void choose_lenses(std::span<CameraReading> cameras, std::optional<LensKind> wanted,
                   const std::string& file, std::vector<Remark>& remarks);

/// Distortion is not left out because of its name: throws Error for entries that look like it where
/// a camera has none, else warns of them in `remarks`.
void look_at_unknown_distortion(const CalibrationNames& names,
                                std::span<const CameraReading> cameras, const std::string& file,
                                std::vector<Remark>& remarks);

/// The numbers of an entry. Throws Error if it does not hold `rows` · `columns`.
const std::vector<double>& values_of(const CalibrationNames::Found& found, int rows, int columns);
Eigen::Matrix3d matrix_of(const CalibrationNames::Found& found);
Matrix34 projection_of(const CalibrationNames::Found& found);
/// A matrix of 4×4, or 3×4 without its last row.
CameraPose transform_of(const CalibrationNames::Found& found);
double number_of(const CalibrationNames::Found& found);
/// Throws Error for anything but 1 to 1e6 whole pixels.
int whole_pixels(double value);

}  // namespace vantage
