#include "engine/view_geometry/trifocal_rectification.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr std::array<std::string_view, 3> kNames = {"first camera", "second camera",
                                                    "camera of the new view"};
constexpr double kLargestRectifiedSide = 16384;
constexpr double kMinElevationDegrees = 5;
// C3 counts as on the baseline if it is off by less than this share of its distance: otherwise
// rounding errors would determine the plane.
constexpr double kOnBaseline = 1e-9;
constexpr double kRounding = 1e-6;  // pixels

using Corners = std::array<Eigen::Vector3d, 4>;

Corners corners_of(const PosedCamera& camera) {
  const double right = camera.width_px - 0.5;
  const double bottom = camera.height_px - 0.5;
  return {Eigen::Vector3d(-0.5, -0.5, 1), Eigen::Vector3d(right, -0.5, 1),
          Eigen::Vector3d(right, bottom, 1), Eigen::Vector3d(-0.5, bottom, 1)};
}

// Rows are X, Y and Z of the frame.
Eigen::Matrix3d frame_of(const std::array<const PosedCamera*, 3>& cameras) {
  const Eigen::Vector3d origin = cameras[0]->centre();
  const Eigen::Vector3d baseline = cameras[1]->centre() - origin;
  const Eigen::Vector3d to_view = cameras[2]->centre() - origin;
  const Eigen::Vector3d viewing =
      (cameras[0]->rotation.row(2) + cameras[1]->rotation.row(2)).transpose();
  const Eigen::Vector3d x = baseline.normalized();
  Eigen::Vector3d z = x.cross(to_view);
  if (z.norm() <= kOnBaseline * std::max(to_view.norm(), baseline.norm())) {
    z = viewing - viewing.dot(x) * x;
    if (z.norm() <= kOnBaseline) {
      throw Error("cameras look along the baseline on average, expected them to look across it");
    }
  }
  z.normalize();
  if (z.dot(viewing) < 0) {
    z = -z;
  }
  Eigen::Matrix3d frame;
  frame.row(0) = x;
  frame.row(1) = z.cross(x);
  frame.row(2) = z;
  return frame;
}

// Resolution at the image centre: 1 / √(area of a pixel on the plane of X/Z, Y/Z).
double resolution(const Eigen::Matrix3d& ray_from_pixel, const PosedCamera& camera) {
  const Eigen::Vector3d middle((camera.width_px - 1) / 2.0, (camera.height_px - 1) / 2.0, 1);
  const double depth = ray_from_pixel.row(2).dot(middle);
  // Determinant of the derivative of a projective map.
  return std::sqrt(std::abs(depth * depth * depth / ray_from_pixel.determinant()));
}

}  // namespace

TrifocalRectification trifocal_rectification(const PosedCamera& first, const PosedCamera& second,
                                             const PosedCamera& view) {
  const std::array<const PosedCamera*, 3> cameras = {&first, &second, &view};
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    cameras[i]->validate(std::string(kNames[i]));
  }
  TrifocalRectification result;
  result.baseline = (second.centre() - first.centre()).norm();
  if (!(result.baseline > 1e-12 * std::max(1.0, first.centre().norm()))) {
    throw Error("first and second camera are at one place, expected a baseline between them");
  }
  result.rotation = frame_of(cameras);
  const Eigen::Vector3d position =
      result.rotation * (view.centre() - first.centre()) / result.baseline;
  result.view_x = position.x();
  result.view_y = position.y();

  std::array<Eigen::Matrix3d, 3> ray_from_pixel;
  Eigen::Vector2d min = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d largest = -min;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    ray_from_pixel[i] =
        result.rotation * cameras[i]->rotation.transpose() * cameras[i]->matrix.inverse();
    for (const Eigen::Vector3d& corner : corners_of(*cameras[i])) {
      const Eigen::Vector3d ray = ray_from_pixel[i] * corner;
      const double elevation = std::asin(ray.z() / ray.norm()) * 180 / std::numbers::pi;
      if (!(elevation >= kMinElevationDegrees)) {
        throw Error(fmt::format(
            "{} sees as low as {:.1f}° above the plane through the three cameras, which would cut "
            "the scene; expected at least {}°",
            kNames[i], elevation, kMinElevationDegrees));
      }
      min = min.cwiseMin(ray.hnormalized());
      largest = largest.cwiseMax(ray.hnormalized());
    }
  }

  result.focal_length_px =
      std::max(resolution(ray_from_pixel[0], first), resolution(ray_from_pixel[1], second));
  // The box is extended to whole pixels from the first image's corner, so that already rectified
  // cameras keep their pixel grid.
  const Eigen::Vector2d corner_px =
      result.focal_length_px * (ray_from_pixel[0] * corners_of(first).front()).hnormalized().eval();
  const Eigen::Array2d above_px = result.focal_length_px * min - corner_px;
  const Eigen::Array2d below_px = result.focal_length_px * largest - corner_px;
  const Eigen::Vector2d first_edge_px = corner_px.array() + (above_px + kRounding).floor();
  const Eigen::Vector2d size_px = (below_px - kRounding).ceil() - (above_px + kRounding).floor();
  if (!(size_px.maxCoeff() <= kLargestRectifiedSide)) {
    throw Error(fmt::format(
        "rectified images would be {:.0f}×{:.0f}, expected at most {:.0f} pixels each way",
        size_px.x(), size_px.y(), kLargestRectifiedSide));
  }
  result.width_px = static_cast<int>(size_px.x());
  result.height_px = static_cast<int>(size_px.y());
  result.principal_point_px = Eigen::Vector2d(-0.5, -0.5) - first_edge_px;
  Eigen::Matrix3d pixel_from_ray = Eigen::Matrix3d::Identity();
  pixel_from_ray(0, 0) = pixel_from_ray(1, 1) = result.focal_length_px;
  pixel_from_ray.topRightCorner<2, 1>() = result.principal_point_px;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    result.homographies[i] = pixel_from_ray * ray_from_pixel[i];
  }
  return result;
}

}  // namespace vantage
