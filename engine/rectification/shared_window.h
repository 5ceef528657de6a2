#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "engine/rectification/camera.h"

namespace vantage {

/// A closed polygon in the plane Z = 1 of some frame.
using RayPolygon = std::vector<Eigen::Vector2d>;

/// Field of view of a camera: the outline of the rays around its principal axis that meet the
/// image, up to the outer edges of its outermost pixels, within the range of the lens model. About
/// 500 corners. The principal point is in the image.
RayPolygon seen_rays(const LensModel& lens, int width_px, int height_px);

/// The polygon seen from a frame rotated by `rotation` (new ← old). None if part of it would be
/// more than 85° off the new frame's Z.
std::optional<RayPolygon> turned(const RayPolygon& polygon, const Eigen::Matrix3d& rotation);

/// A rectangle in the plane Z = 1 with the aspect ratio of its image, whose pixel (x, y) lies at
/// centre + scale · (x − (width − 1)/2, y − (height − 1)/2).
struct RayWindow {
  Eigen::Vector2d centre = {0, 0};
  double scale = 0;  ///< rays per pixel, 1 / focal length
};

/// The largest window of that image inside both polygons. None if their interiors do not overlap.
std::optional<RayWindow> largest_window_inside(const std::array<RayPolygon, 2>& polygons,
                                               int width_px, int height_px);

/// The smallest window of that image around both polygons.
RayWindow smallest_window_around(const std::array<RayPolygon, 2>& polygons, int width_px,
                                 int height_px);

}  // namespace vantage
