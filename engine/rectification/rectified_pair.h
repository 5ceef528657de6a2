#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// Field of view of rectified images.
struct RectificationOptions {
  /// 0: the largest window without pixels that the cameras did not see (default); 1: everything
  /// that either camera saw, with black around it; in between, the window is interpolated.
  double kept_outline = 0;
  /// Accepts cameras in any direction from each other, as above or swapped: rows of the rectified
  /// images follow the baseline from left to right, turned from the photographs as needed, with
  /// width and height exchanged where it is nearer to the cameras' y axes.
  bool any_direction = false;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
};

/// A rectangle of whole pixels.
struct PixelRectangle {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// A camera rotated to form a rectified pair with another one.
struct RectifiedCamera {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();    ///< K of the rectified image
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< rectified frame ← that of the camera
  /// Rectified pixel ← undistorted pixel of the camera.
  Eigen::Matrix3d homography = Eigen::Matrix3d::Identity();
};

/// Rectified cameras side by side on a common X axis: a point (X, Y, Z) of the left one's frame is
/// seen at d = fx · baseline / Z − doffs_px.
struct RectifiedPair {
  int width_px = 0;
  int height_px = 0;
  RectifiedCamera left;
  RectifiedCamera right;
  double baseline = 0;  ///< in the calibration's unit
  /// cx of the right − cx of the left camera. 0 unless the calibration is of rectified images.
  double doffs_px = 0;
  /// The area without black pixels in either image.
  PixelRectangle valid;
  std::vector<Remark> remarks = {};  ///< of the calibration

  [[nodiscard]] const RectifiedCamera& camera(Side side) const {
    return side == Side::kLeft ? left : right;
  }
};

/// The rectified cameras of images of this size, which is also the size of the rectified images
/// (but see RectificationOptions::any_direction).
///
/// X is the direction of the baseline, Z the part of the mean viewing direction orthogonal to it, Y
/// = Z × X (EQUATIONS §6), so both cameras rotate by about the same angle. Both rectified cameras
/// have one focal length, the same in x and y, and one principal point: infinity has disparity 0. A
/// rectified calibration is returned unchanged.
///
/// A calibration for another size of images of this shape is scaled
/// (StereoCalibration::for_images).
///
/// Throws Error, naming the calibration's file, quantity and limit, for an image size that
/// contradicts the calibration, a baseline more than 45° off the cameras' x axes (cameras one above
/// or behind the other, or swapped), viewing directions 90° apart, or views with almost no overlap.
///
/// Thread rule: pure.
RectifiedPair rectified_pair(const StereoCalibration& calibration, int width_px, int height_px,
                             const RectificationOptions& options = {});

}  // namespace vantage
