#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/rectification/camera_pose.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// An image and where its camera stands.
struct PosedImage {
  std::string name;  ///< path relative to the folder of the images
  SizedCamera camera;
  CameraPose pose;
};

/// Parses cameras.txt: lines CAMERA_ID MODEL WIDTH HEIGHT PARAMS…, by their number. Models:
/// SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV, OPENCV_FISHEYE,
/// SIMPLE_RADIAL_FISHEYE, RADIAL_FISHEYE. COLMAP's pixel centres are at halves, so principal points
/// are moved by half a pixel. Throws Error naming `file` and the
/// line.
std::map<long long, SizedCamera> parse_colmap_cameras(std::string_view text,
                                                      const std::string& file);

/// Parses images.txt: IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, world to camera, each followed
/// by a line of points, which is skipped. Sorted by name. Throws Error naming `file` and the line,
/// also for a camera that is not among `cameras`, and for two images of one name.
std::vector<PosedImage> parse_colmap_images(std::string_view text, const std::string& file,
                                            const std::map<long long, SizedCamera>& cameras);

/// The model in a folder: cameras.txt and images.txt, at least one image. Throws Error, also for
/// binary models. Thread rule: may be called concurrently.
std::vector<PosedImage> read_colmap_model(const std::filesystem::path& folder);

}  // namespace vantage
