#pragma once

#include <filesystem>
#include <optional>
#include <span>

namespace vantage {

/// The two stereo pairs of KITTI's rig. Their baselines differ by about 1 %.
enum class KittiCameras {
  kGrey,   ///< cameras 0 and 1
  kColour  ///< cameras 2 and 3
};

/// Which pair took these images, by the names of KITTI's folders: image_0, image_1 (or image_00,
/// image_01) are grey; image_2, image_3 (or image_02, image_03), colored_0 and colored_1 are
/// colour. Empty: no path has such a folder, or they do not agree. Reads no files. Thread rule: may
/// be called concurrently.
std::optional<KittiCameras> kitti_cameras_of(std::span<const std::filesystem::path> images);
/// The same for images of one camera: its number, 0 to 3 (colored_0 is 2).
std::optional<int> kitti_camera_of(std::span<const std::filesystem::path> images);

}  // namespace vantage
