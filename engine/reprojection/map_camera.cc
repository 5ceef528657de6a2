#include "engine/reprojection/map_camera.h"

#include <Eigen/LU>
#include <cmath>

namespace vantage {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Empty where there is no point.
std::optional<double> depth_within(const DepthScale& scale, float disparity_px, double max_depth) {
  const std::optional<double> value = depth(scale, static_cast<double>(disparity_px));
  // Infinite disparities are unknown, too: their depth is 0.
  return value && *value > 0 && *value <= max_depth ? value : std::nullopt;
}

}  // namespace

MapCamera map_camera(const RectifiedPair& pair, Side side, double metres_per_unit) {
  const RectifiedCamera& camera = pair.camera(side);
  const double baseline = pair.baseline * metres_per_unit;
  MapCamera result{.scale = {.focal_length_px = camera.matrix(0, 0),
                             .baseline = baseline,
                             .doffs_px = pair.doffs_px},
                   .matrix = camera.matrix};
  if (side == Side::kRight) {
    result.centre.x() = baseline;
  }
  return result;
}

MapCamera in_world(const MapCamera& camera, const Eigen::Matrix3d& rotation,
                   const Eigen::Vector3d& translation, const Eigen::Matrix3d& rectified_rotation) {
  const Eigen::Matrix3d world_from_rectified = rotation * rectified_rotation.transpose();
  MapCamera result = camera;
  result.rotation = world_from_rectified * camera.rotation;
  result.centre = world_from_rectified * camera.centre + translation;
  return result;
}

void depth_map(ImageView<const float> disparity_px, const DepthScale& scale, double max_depth,
               Execution& execution, Image<float>& depths) {
  depths.resize(disparity_px.width(), disparity_px.height());
  execution.for_each_row(disparity_px.height(), [&](int y) {
    for (int x = 0; x < disparity_px.width(); ++x) {
      const auto value = depth_within(scale, disparity_px.at(x, y), max_depth);
      depths.at(x, y) = value ? static_cast<float>(*value) : kUnknown;
    }
  });
}

void disparity_map(ImageView<const float> depths, const DepthScale& scale, Execution& execution,
                   Image<float>& disparity_px) {
  disparity_px.resize(depths.width(), depths.height());
  const double product = scale.focal_length_px * scale.baseline;
  execution.for_each_row(depths.height(), [&](int y) {
    for (int x = 0; x < depths.width(); ++x) {
      const float depth = depths.at(x, y);
      disparity_px.at(x, y) =
          depth > 0 && std::isfinite(depth)
              ? static_cast<float>(product / static_cast<double>(depth) - scale.doffs_px)
              : kUnknown;
    }
  });
}

void reproject(ImageView<const float> disparity_px, const MapCamera& camera, double max_depth,
               Execution& execution, Image<float>& points) {
  points.resize(disparity_px.width(), disparity_px.height(), 3);
  const Eigen::Matrix3d ray_from_pixel = camera.rotation * camera.matrix.inverse();
  execution.for_each_row(disparity_px.height(), [&](int y) {
    for (int x = 0; x < disparity_px.width(); ++x) {
      const auto value = depth_within(camera.scale, disparity_px.at(x, y), max_depth);
      const Eigen::Vector3d point =
          ray_from_pixel * Eigen::Vector3d(x, y, 1) * value.value_or(0) + camera.centre;
      for (int axis = 0; axis < 3; ++axis) {
        points.at(x, y, axis) = value ? static_cast<float>(point[axis]) : kUnknown;
      }
    }
  });
}

}  // namespace vantage
