#include "engine/view_geometry/new_view.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "engine/error.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage {
namespace {

// The right image's pixel (x, y) shows what the left one shows at x + d.
ViewWarp from_right(const ViewWarp& from_left) {
  return {.homography = from_left.homography,
          .parallax = from_left.parallax + from_left.homography.col(0)};
}

// λ is linear in x, y and d: its maximum is at a corner.
double largest_depth_ratio(const NewView& view, const RectifiedPair& pair) {
  double largest = -1;
  const double nearest = view.infinity_disparity_px + pair.width_px;
  for (const double x : {0.0, pair.width_px - 1.0}) {
    for (const double y : {0.0, pair.height_px - 1.0}) {
      for (const double d : {view.infinity_disparity_px, nearest}) {
        const double ratio = view.from_left.homography.row(2).dot(Eigen::Vector3d(x, y, 1)) +
                             d * view.from_left.parallax.z();
        largest = std::max(largest, ratio);
      }
    }
  }
  return largest;
}

}  // namespace

bool ViewWarp::is_translation() const {
  return homography == Eigen::Matrix3d::Identity() && parallax.z() == 0;
}

NewView baseline_view(double view_x, double view_y, int width_px, int height_px) {
  if (!(std::abs(view_x) <= kMaxViewDistance) || !(std::abs(view_y) <= kMaxViewDistance)) {
    throw UsageError(fmt::format("view is at {}, {} baselines, expected both within -{}..{}",
                                 view_x, view_y, kMaxViewDistance, kMaxViewDistance));
  }
  NewView view;
  view.width_px = width_px;
  view.height_px = height_px;
  view.from_left.parallax = {-view_x, -view_y, 0};
  view.from_right = from_right(view.from_left);
  view.distance_from_left = std::hypot(view_x, view_y);
  view.distance_from_right = std::hypot(view_x - 1, view_y);
  return view;
}

NewView camera_view(const RectifiedPair& pair, const PosedCamera& camera) {
  camera.validate("camera of the new view");
  const Eigen::Vector3d centre = camera.centre();
  NewView view;
  view.width_px = camera.width_px;
  view.height_px = camera.height_px;
  view.distance_from_left = centre.norm() / pair.baseline;
  view.distance_from_right = (centre - Eigen::Vector3d(pair.baseline, 0, 0)).norm() / pair.baseline;
  if (!(std::min(view.distance_from_left, view.distance_from_right) <= kMaxViewDistance)) {
    throw Error(fmt::format(
        "camera of the new view is {:.4g} baselines from the left camera, expected at most {}",
        view.distance_from_left, kMaxViewDistance));
  }
  // With d + doffs = f b / Z: λ (u, v, 1) = K₃ R₃ K⁻¹ (x, y, 1) + (d + doffs) K₃ t₃ / (f b).
  const Eigen::Vector3d parallax =
      camera.matrix * camera.translation / (pair.left.matrix(0, 0) * pair.baseline);
  view.infinity_disparity_px = -pair.doffs_px;
  view.from_left.parallax = parallax;
  view.from_left.homography = camera.matrix * camera.rotation * pair.left.matrix.inverse();
  view.from_left.homography.col(2) += pair.doffs_px * parallax;
  view.from_right = from_right(view.from_left);
  if (!(largest_depth_ratio(view, pair) > 0)) {
    throw Error(
        "camera of the new view looks away: everything the pair can show is behind it, expected "
        "depths above 0");
  }
  return view;
}

}  // namespace vantage
