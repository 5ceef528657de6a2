#pragma once

#include <Eigen/Core>

#include "engine/image/image.h"
#include "engine/view_geometry/new_view.h"

namespace vantage {

// Of maps that hold d = scale / Z of the pinhole cameras of a scene; NaN = unknown. Thread rule:
// pure.

/// Disparities of neighbouring pixels of one surface differ by at most this.
inline constexpr float kSurfaceLimit_px = 1;

/// (u, v) in the other image of the pixel (x, y) with disparity d, and the depth there as a share
/// of that in this image.
inline Eigen::Vector3d projected(const ViewWarp& to_other, double x, double y, double d) {
  const Eigen::Vector3d seen =
      to_other.homography * Eigen::Vector3d(x, y, 1) + d * to_other.parallax;
  return {seen.x() / seen.z(), seen.y() / seen.z(), seen.z()};
}

/// Coefficients (a, b, c) of the plane d = a (x − x₀) + b (y − y₀) + c through the disparities of
/// the surface around a pixel (x₀, y₀), whose disparity is known.
Eigen::Vector3d plane_around(const DisparityMap& map, int x0, int y0);

/// The disparity at a position within a map, in pixels from the centre of its first one: bilinear
/// among four pixels that differ by at most 1 px, else that of the nearest. NaN = unknown. Thread
/// rule: pure.
float interpolated_disparity(ImageView<const float> map, double x, double y);

}  // namespace vantage
