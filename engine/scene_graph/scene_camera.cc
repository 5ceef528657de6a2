#include "engine/scene_graph/scene_camera.h"

#include <Eigen/Dense>

namespace vantage {

StereoCalibration calibration_of(const SceneCamera& first, const SceneCamera& second, int width_px,
                                 int height_px) {
  const CameraPose pose = relative_pose(first.pose, second.pose);
  return {.left = first.lens,
          .right = second.lens,
          .rotation = pose.rotation,
          .translation = pose.translation,
          .image_size = ImageSize{width_px, height_px},
          .format = "posed cameras"};
}

ViewWarp warp_between(const SceneCamera& source, const Eigen::Matrix3d& matrix,
                      const CameraPose& pose, double scale_px) {
  const CameraPose relative = relative_pose(source.pose, pose);
  // λ (u, v, 1) = K₂ R K₁⁻¹ (x, y, 1) + d K₂ t / scale, with d = scale / Z.
  return {.homography = matrix * relative.rotation * source.lens.matrix.inverse(),
          .parallax = matrix * relative.translation / scale_px};
}

}  // namespace vantage
