#include "engine/rectification/rectified_pair.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/error.h"
#include "engine/rectification/rotations.h"
#include "engine/rectification/shared_window.h"

namespace vantage {
namespace {

constexpr double kMaxBaselineAngleDegrees = 45;
constexpr double kMaxViewingAngleDegrees = 90;
/// A window that shows less than this share of a camera's height and width is too small.
constexpr double kMinShare = 0.1;

/// Direction of the right camera, in the left one's frame.
Eigen::Vector3d baseline_direction(const StereoCalibration& calibration) {
  return (-calibration.rotation.transpose() * calibration.translation).normalized();
}

/// The mean of both cameras' x axes, in the left one's frame.
Eigen::Vector3d mean_x_axis(const StereoCalibration& calibration) {
  return Eigen::Vector3d::UnitX() + calibration.rotation.row(0).transpose();
}

/// Throws Error unless the cameras are side by side.
void require_side_by_side(const StereoCalibration& calibration) {
  const double angle =
      degrees(angle_between(baseline_direction(calibration), mean_x_axis(calibration)));
  if (angle >= 180 - kMaxBaselineAngleDegrees) {
    throw Error("the right camera is to the left of the left one, expected the cameras swapped");
  }
  if (!(angle <= kMaxBaselineAngleDegrees)) {
    throw Error(
        fmt::format("the baseline is turned {:.1f} degrees from the cameras' x axes, limit {}: "
                    "expected cameras side by side",
                    angle, kMaxBaselineAngleDegrees));
  }
}

/// Whether the baseline is nearer to the cameras' y axes than to their x axes.
bool is_upright(const StereoCalibration& calibration) {
  const double angle =
      degrees(angle_between(baseline_direction(calibration), mean_x_axis(calibration)));
  return angle > kMaxBaselineAngleDegrees && angle < 180 - kMaxBaselineAngleDegrees;
}

/// Rectified frame ← left camera's frame.
Eigen::Matrix3d rectifying_rotation(const StereoCalibration& calibration,
                                    const RectificationOptions& options) {
  const Eigen::Matrix3d& right_axes = calibration.rotation;  // rows, in the left camera's frame
  const Eigen::Vector3d x_axis = baseline_direction(calibration);
  const Eigen::Vector3d mean_view = Eigen::Vector3d::UnitZ() + right_axes.row(2).transpose();

  const double view_angle = degrees(angle_between(Eigen::Vector3d::UnitZ(), right_axes.row(2)));
  if (!(view_angle <= kMaxViewingAngleDegrees)) {
    throw Error(fmt::format("the cameras' viewing directions are {:.1f} degrees apart, limit {}",
                            view_angle, kMaxViewingAngleDegrees));
  }
  if (!options.any_direction) {
    require_side_by_side(calibration);
  }
  const Eigen::Vector3d z_axis = (mean_view - mean_view.dot(x_axis) * x_axis).normalized();
  Eigen::Matrix3d rotation;
  rotation << x_axis.transpose(), z_axis.cross(x_axis).transpose(), z_axis.transpose();
  return rotation;
}

Eigen::Matrix3d camera_of(const RayWindow& window, int width_px, int height_px) {
  const double focal = 1 / window.scale;
  Eigen::Matrix3d matrix;
  matrix << focal, 0, (width_px - 1) / 2.0 - focal * window.centre.x(), 0, focal,
      (height_px - 1) / 2.0 - focal * window.centre.y(), 0, 0, 1;
  return matrix;
}

/// The pixels of the image that shows `shown` whose centres lie in `inner`.
PixelRectangle pixels_within(const RayWindow& inner, const RayWindow& shown, int width_px,
                             int height_px) {
  const auto interval = [&](int axis, int size_px) {
    const double middle =
        (size_px - 1) / 2.0 + (inner.centre[axis] - shown.centre[axis]) / shown.scale;
    const double half = size_px / 2.0 * inner.scale / shown.scale;
    const int first = std::clamp(static_cast<int>(std::ceil(middle - half)), 0, size_px - 1);
    const int last = std::clamp(static_cast<int>(std::floor(middle + half)), 0, size_px - 1);
    return std::pair{first, std::max(last - first + 1, 0)};
  };
  const auto [x, width] = interval(0, width_px);
  const auto [y, height] = interval(1, height_px);
  return {.x = x, .y = y, .width = width, .height = height};
}

RectifiedPair unchanged_pair(const StereoCalibration& calibration, int width_px, int height_px) {
  return {.width_px = width_px,
          .height_px = height_px,
          .left = {.matrix = calibration.left.matrix},
          .right = {.matrix = calibration.right.matrix},
          .baseline = calibration.baseline(),
          .doffs_px = calibration.doffs_px(),
          .valid = {.x = 0, .y = 0, .width = width_px, .height = height_px},
          .remarks = calibration.remarks};
}

/// Throws errors that do not name the calibration's file.
RectifiedPair pair_of(const StereoCalibration& calibration, int width_px, int height_px,
                      const RectificationOptions& options) {
  calibration.validate();
  calibration.check_image_size(width_px, height_px);
  if (calibration.is_rectified) {
    return unchanged_pair(calibration, width_px, height_px);
  }

  const Eigen::Matrix3d left_rotation = rectifying_rotation(calibration, options);
  const Eigen::Matrix3d right_rotation = left_rotation * calibration.rotation.transpose();
  const auto left_seen =
      turned(seen_rays(LensModel(calibration.left), width_px, height_px), left_rotation);
  const auto right_seen =
      turned(seen_rays(LensModel(calibration.right), width_px, height_px), right_rotation);
  if (!left_seen || !right_seen) {
    throw Error(
        "a camera sees more than 85 degrees off the rectified viewing direction, expected cameras "
        "that look across their baseline");
  }
  const std::array<RayPolygon, 2> seen = {*left_seen, *right_seen};
  if (options.any_direction && is_upright(calibration)) {
    std::swap(width_px, height_px);
  }
  const auto inner = largest_window_inside(seen, width_px, height_px);
  const RayWindow outer = smallest_window_around(seen, width_px, height_px);
  const double share = inner ? inner->scale / outer.scale : 0;
  if (!(share >= kMinShare)) {
    throw Error(
        fmt::format("the cameras' common view is {:.1f} % as wide as what they see, expected at "
                    "least {} %",
                    100 * share, 100 * kMinShare));
  }
  const double kept = options.kept_outline;
  const RayWindow shown = {.centre = (1 - kept) * inner->centre + kept * outer.centre,
                           .scale = (1 - kept) * inner->scale + kept * outer.scale};
  const Eigen::Matrix3d matrix = camera_of(shown, width_px, height_px);
  const auto camera = [&](const Camera& source, const Eigen::Matrix3d& rotation) {
    return RectifiedCamera{.matrix = matrix,
                           .rotation = rotation,
                           .homography = matrix * rotation * source.matrix.inverse()};
  };
  return {.width_px = width_px,
          .height_px = height_px,
          .left = camera(calibration.left, left_rotation),
          .right = camera(calibration.right, right_rotation),
          .baseline = calibration.baseline(),
          .doffs_px = 0,
          .valid = pixels_within(*inner, shown, width_px, height_px),
          .remarks = calibration.remarks};
}
}  // namespace

void RectificationOptions::validate() const {
  if (!(kept_outline >= 0 && kept_outline <= 1)) {
    throw UsageError(fmt::format("kept-outline is {}, expected 0 to 1", kept_outline));
  }
}

RectifiedPair rectified_pair(const StereoCalibration& calibration, int width_px, int height_px,
                             const RectificationOptions& options) {
  options.validate();
  try {
    return pair_of(calibration.for_images(width_px, height_px), width_px, height_px, options);
  } catch (const Error& error) {
    throw calibration.file.empty() ? error
                                   : Error(fmt::format("{}: {}", calibration.file, error.what()));
  }
}

}  // namespace vantage
