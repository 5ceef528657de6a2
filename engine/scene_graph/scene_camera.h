#pragma once

#include "engine/rectification/camera.h"
#include "engine/rectification/camera_pose.h"
#include "engine/rectification/stereo_calibration.h"
#include "engine/view_geometry/new_view.h"

namespace vantage {

/// A camera of a scene: its lens, and where it stands in the world.
struct SceneCamera {
  Camera lens;
  CameraPose pose;

  friend bool operator==(const SceneCamera& a, const SceneCamera& b) {
    return a.lens.matrix == b.lens.matrix && a.lens.distortion == b.lens.distortion &&
           a.lens.lens == b.lens.lens && a.pose == b.pose;
  }
};

/// The pair of two cameras, as a calibration of images of this size.
StereoCalibration calibration_of(const SceneCamera& first, const SceneCamera& second, int width_px,
                                 int height_px);

/// From pixels of `source` without distortion, with disparities d = `scale_px` / Z, to those of a
/// pinhole camera with this matrix and pose.
ViewWarp warp_between(const SceneCamera& source, const Eigen::Matrix3d& matrix,
                      const CameraPose& pose, double scale_px);

}  // namespace vantage
