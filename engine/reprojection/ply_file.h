#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/reprojection/point_cloud.h"

namespace vantage {

// Thread rule: all functions here are pure.

/// Comments on the coordinates.
inline constexpr std::string_view kCameraFrame =
    "metres in the frame of the rectified left camera: x right, y down, z ahead";
inline constexpr std::string_view kWorldFrame = "metres in the world frame of the poses";
inline constexpr std::string_view kPoseFrame = "world frame and unit of the poses";

/// A binary little-endian PLY file with the element `vertex`: float x, y, z; float nx, ny, nz if
/// the points have normals; uchar red, green, blue; float confidence if the points have it. `frame`
/// is a comment on the coordinates, one line.
std::vector<std::uint8_t> encode_ply(const PointCloud& cloud, std::string_view frame);

/// The same, followed by the element `face`: a list of three vertices per triangle.
std::vector<std::uint8_t> encode_ply(const TriangleMesh& mesh, std::string_view frame);

}  // namespace vantage
