#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene_graph/scene_builder.h"

namespace vantage::apps {

/// Reads poses and joins them with image files.
///  - `poses` is a folder with a COLMAP model: its images are in the folder `images`.
///  - `poses` is transforms.json of NeRF tools: likewise, with or without folders and extensions.
///  - A file with OpenCV's camera and extrinsic_parameters: poses belong to the images of the
///  sequence `images` in order; `intrinsics` may be empty.
///  - A TUM, KITTI or EuRoC trajectory: `intrinsics` is the file of the camera, `lens` what its
///  four coefficients are. TUM poses belong to the images whose names are times, the nearest one
///  within 0.02 s; images without one are left out, which `remarks` says; if the names are no
///  times, and for KITTI, to the images in order.
/// Throws Error of one line naming the file, UsageError for a missing option.
std::vector<SceneImage> posed_scene_images(const std::filesystem::path& poses,
                                           const std::string& images,
                                           const std::filesystem::path& intrinsics,
                                           std::optional<LensKind> lens,
                                           std::vector<std::string>& remarks);

}  // namespace vantage::apps
