#include "engine/rectification/kitti_cameras.h"

#include <array>
#include <string_view>
#include <utility>

namespace vantage {
namespace {

constexpr std::array<std::pair<std::string_view, KittiCameras>, 10> kFolders = {{
    {"image_0", KittiCameras::kGrey},
    {"image_1", KittiCameras::kGrey},
    {"image_00", KittiCameras::kGrey},
    {"image_01", KittiCameras::kGrey},
    {"image_2", KittiCameras::kColour},
    {"image_3", KittiCameras::kColour},
    {"image_02", KittiCameras::kColour},
    {"image_03", KittiCameras::kColour},
    {"colored_0", KittiCameras::kColour},  // of the stereo benchmark of 2012
    {"colored_1", KittiCameras::kColour},
}};

/// That of the innermost folder with one of the names.
std::optional<KittiCameras> cameras_of(const std::filesystem::path& image) {
  std::optional<KittiCameras> cameras;
  if (image.empty()) {
    return cameras;
  }
  for (const std::filesystem::path& part : std::filesystem::absolute(image).lexically_normal()) {
    for (const auto& [name, of_name] : kFolders) {
      if (part == name) {
        cameras = of_name;
      }
    }
  }
  return cameras;
}

}  // namespace

std::optional<KittiCameras> kitti_cameras_of(std::span<const std::filesystem::path> images) {
  std::optional<KittiCameras> agreed;
  for (const std::filesystem::path& image : images) {
    const std::optional<KittiCameras> cameras = cameras_of(image);
    if (cameras && agreed && cameras != agreed) {
      return std::nullopt;
    }
    agreed = cameras ? cameras : agreed;
  }
  return agreed;
}

}  // namespace vantage
