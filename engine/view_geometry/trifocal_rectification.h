#pragma once

#include <Eigen/Core>
#include <array>

#include "engine/view_geometry/posed_camera.h"

namespace vantage {

/// Three cameras rotated and cropped so that their images lie on one common plane, parallel to the
/// plane through their centres (three-view rectification, 3.8). A point at disparity d between the
/// rectified images of cameras 1 and 2 has p3 = p1 − d · (XS, YS) and p3 = p2 − d · (XS − 1, YS)
/// (3.5).
///
/// The frame: origin C1, X towards C2, lengths in baselines, C3 in the plane Z = 0, Y = Z × X; Z
/// points such that cameras 1 and 2 look towards growing Z on average. With C3 on the baseline Z is
/// the part of the mean viewing direction orthogonal to it.
struct TrifocalRectification {
  Eigen::Matrix3d rotation;  ///< frame ← reference frame of the cameras
  double baseline = 0;       ///< |C2 − C1| in the cameras' unit
  double view_x = 0;         ///< XS: C3 in the frame
  double view_y = 0;         ///< YS
  /// Pixels per unit of X/Z and of Y/Z: d = focal_length_px / Z with Z in baselines.
  double focal_length_px = 0;
  /// The X/Z = Y/Z = 0 ray in all three rectified images.
  Eigen::Vector2d principal_point_px;
  /// Size of all three rectified images: the bounding box of the cameras' fields of view.
  int width_px = 0;
  int height_px = 0;
  /// H1, H2, H3: rectified pixel ← pixel of the camera, homogeneous.
  std::array<Eigen::Matrix3d, 3> homographies;
};

/// `first` and `second` are the cameras of the pair, `view` is the new one; all in one reference
/// frame. The common scale preserves the resolution of cameras 1 and 2 at the centre of their
/// images. Throws Error of one line, naming quantity and limit: cameras 1 and 2 at one position; an
/// image any part of which is seen less than 5° above the plane of the three centres, which then
/// intersects the scene; rectified images of more than 16384 pixels in width or height.
TrifocalRectification trifocal_rectification(const PosedCamera& first, const PosedCamera& second,
                                             const PosedCamera& view);

}  // namespace vantage
