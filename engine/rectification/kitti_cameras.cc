#include "engine/rectification/kitti_cameras.h"

#include <array>
#include <string_view>
#include <utility>

namespace vantage {
namespace {

constexpr std::array<std::pair<std::string_view, int>, 10> kFolders = {{
    {"image_0", 0},
    {"image_1", 1},
    {"image_00", 0},
    {"image_01", 1},
    {"image_2", 2},
    {"image_3", 3},
    {"image_02", 2},
    {"image_03", 3},
    {"colored_0", 2},  // of the stereo benchmark of 2012
    {"colored_1", 3},
}};

/// That of the innermost folder with one of the names.
std::optional<int> camera_of(const std::filesystem::path& image) {
  std::optional<int> camera;
  if (image.empty()) {
    return camera;
  }
  for (const std::filesystem::path& part : std::filesystem::absolute(image).lexically_normal()) {
    for (const auto& [name, of_name] : kFolders) {
      if (part == name) {
        camera = of_name;
      }
    }
  }
  return camera;
}

KittiCameras pair_of(int camera) {
  return camera < 2 ? KittiCameras::kGrey : KittiCameras::kColour;
}

/// What of_camera(number) is for all images that are in a folder of KITTI's.
template <typename OfCamera>
auto agreed(std::span<const std::filesystem::path> images, const OfCamera& of_camera) {
  std::optional<decltype(of_camera(0))> found;
  for (const std::filesystem::path& image : images) {
    const std::optional<int> camera = camera_of(image);
    if (camera && found && of_camera(*camera) != *found) {
      return std::optional<decltype(of_camera(0))>();
    }
    if (camera) {
      found = of_camera(*camera);
    }
  }
  return found;
}

}  // namespace

std::optional<KittiCameras> kitti_cameras_of(std::span<const std::filesystem::path> images) {
  return agreed(images, pair_of);
}

std::optional<int> kitti_camera_of(std::span<const std::filesystem::path> images) {
  return agreed(images, [](int camera) { return camera; });
}

}  // namespace vantage
