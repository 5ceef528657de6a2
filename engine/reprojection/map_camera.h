#pragma once

#include <Eigen/Core>
#include <limits>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/side.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/view_geometry/depth_resolution.h"

namespace vantage {

// Thread rule: all functions here are pure; those with an `execution` run on its threads.

/// The camera of a disparity map: what turns its pixels into points. A pixel (x, y) at depth Z is
/// the point rotation · (matrix⁻¹ (x, y, 1) · Z) + centre. All axes are OpenCV's: x right, y down,
/// z ahead. Lengths are in the unit of `scale.baseline`.
struct MapCamera {
  DepthScale scale = {};
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();  ///< K of the rectified image
  /// Frame of the points ← rectified camera. The identity: points are in the frame of the rectified
  /// left camera.
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of this camera, in the frame of the points
};

/// The camera of the map of one image of a pair. Points are in the frame of the rectified left
/// camera. `metres_per_unit` (above 0) converts the calibration's unit.
MapCamera map_camera(const RectifiedPair& pair, Side side, double metres_per_unit = 1);

/// `camera` with points in the world, where the left camera stands at a pose: x_world = rotation ·
/// x_left + translation, lengths in the unit of the map's camera. `rectified_rotation` is that of
/// RectifiedCamera (rectified frame ← frame of the left camera), the identity for images that were
/// taken rectified.
MapCamera in_world(const MapCamera& camera, const Eigen::Matrix3d& rotation,
                   const Eigen::Vector3d& translation,
                   const Eigen::Matrix3d& rectified_rotation = Eigen::Matrix3d::Identity());

constexpr double kNoMaxDepth = std::numeric_limits<double>::infinity();

/// Depths of a map, NaN where the disparity is unknown, infinitely far, or farther than `max_depth`
/// (above 0). One channel, resizes `depths`. Identical for any `execution`.
void depth_map(ImageView<const float> disparity_px, const DepthScale& scale, double max_depth,
               Execution& execution, Image<float>& depths);

/// The opposite: disparities f · b / Z − doffs of depths in the unit of the baseline, NaN where a
/// depth is not above 0 or not finite. Resizes `disparity_px`. Identical for any `execution`.
void disparity_map(ImageView<const float> depths, const DepthScale& scale, Execution& execution,
                   Image<float>& disparity_px);

/// Points of a map: X, Y, Z in three channels, all NaN where depth_map() has NaN. Resizes `points`.
/// Identical for any `execution`.
void reproject(ImageView<const float> disparity_px, const MapCamera& camera, double max_depth,
               Execution& execution, Image<float>& points);

}  // namespace vantage
