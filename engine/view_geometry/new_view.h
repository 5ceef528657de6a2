#pragma once

#include <Eigen/Core>

#include "engine/rectification/rectified_pair.h"
#include "engine/view_geometry/posed_camera.h"

namespace vantage {

/// Projection of one image of a rectified pair into a new view: a pixel (x, y) of disparity d is
/// mapped to λ (u, v, 1) = homography · (x, y, 1) + d · parallax. The homography is that of the
/// points at d = 0; for a rectified pair without offset, of the points at infinity.
struct ViewWarp {
  Eigen::Matrix3d homography = Eigen::Matrix3d::Identity();
  Eigen::Vector3d parallax = Eigen::Vector3d::Zero();

  /// True if the new view is a camera of equal orientation and focal length in the baseline's
  /// plane: λ = 1, u = x − s_x d, v = y − s_y d (3.5).
  [[nodiscard]] bool is_translation() const;
};

/// Distance in baselines below which a new camera coincides with a camera of the pair, to absorb
/// rounding errors.
inline constexpr double kSamePlace = 1e-4;

/// α = dR / (dL + dR) (3.14), the share of the left image in a view at these distances from the
/// cameras, in baselines (3.13); 1 or 0 at the position of one of them.
[[nodiscard]] inline double share_of_left(double distance_from_left, double distance_from_right) {
  if (distance_from_left < kSamePlace || distance_from_right < kSamePlace) {
    return distance_from_left < kSamePlace ? 1 : 0;
  }
  return distance_from_right / (distance_from_left + distance_from_right);
}

/// A new view of a rectified pair.
///
/// Points on one ray of the new view are ordered by nearness q = (d − infinity_disparity_px) / λ.
/// In both warps λ is depth in the new camera ÷ depth in the pair, so q is the disparity that the
/// pair would see at the point's depth in the new camera: one scale for both images, equal to d for
/// pure translations.
struct NewView {
  int width_px = 0;
  int height_px = 0;
  ViewWarp from_left;
  ViewWarp from_right;
  double infinity_disparity_px = 0;  ///< disparity of points at infinity
  /// Distances of the new camera from the left and the right one, in baselines (3.13).
  double distance_from_left = 0;
  double distance_from_right = 1;

  [[nodiscard]] double alpha() const {
    return share_of_left(distance_from_left, distance_from_right);
  }
};

/// The view at (XS, YS) baselines with the orientation, focal length and size of the pair's images
/// (EQUATIONS §6, warp): from_left moves pixels by −d (XS, YS), from_right by −d (XS − 1, YS).
/// Throws UsageError unless both are within ±16.
NewView baseline_view(double view_x, double view_y, int width_px, int height_px);

/// The view of any camera: the product of three-view rectification, warp and derectification (3.8,
/// 3.5). Unlike those it has no plane that must not intersect the scene. Throws Error, naming
/// quantity and limit, for an invalid camera, one more than 16 baselines away, or one that has
/// behind it everything that an image of the pair's size can show.
NewView camera_view(const RectifiedPair& pair, const PosedCamera& camera);

}  // namespace vantage
