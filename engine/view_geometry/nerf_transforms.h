#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/rectification/calibration/posed_images.h"

namespace vantage {

/// Whether a text is JSON, as transforms.json of NeRF tools is.
bool is_nerf_transforms(std::string_view text);

/// Parses transforms.json of NeRF tools: frames with file_path and transform_matrix (4×4, camera to
/// world; their cameras look along −Z, with Y upwards), and of all of them, or each, fl_x, fl_y,
/// cx, cy, w, h and k1 k2 p1 p2, or k1 k2 k3 k4 where camera_model is OPENCV_FISHEYE; or
/// camera_angle_x, with the principal point in the middle. `size_of` tells the size of an image
/// whose frame lacks w and h; without it, cameras are not read. Sorted by name. Throws Error naming
/// `file`. Thread rule: may be called concurrently.
std::vector<PosedImage> parse_nerf_transforms(
    std::string_view text, const std::string& file,
    const std::function<ImageSize(const std::string& name)>& size_of = {});

}  // namespace vantage
