#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "engine/pose_estimation/feature_tracks.h"
#include "engine/rectification/camera_pose.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// An image of a model to be written.
struct PosedImageName {
  std::string name;  ///< path relative to the folder of the images
  CameraPose pose;
};

/// Writes a COLMAP model as text, cameras.txt, images.txt and points3D.txt, to a folder that
/// exists. All images are of one `camera` (PINHOLE, OPENCV, FULL_OPENCV or
/// OPENCV_FISHEYE), whose size is known.
/// Sightings of `points` are numbers of `images`, and positions from the principal point without
/// distortion, in pixels of fx. Points are grey. Throws Error, also for a lens of more than 8
/// coefficients, and for names with line breaks.
void write_colmap_model(const std::filesystem::path& folder, const SizedCamera& camera,
                        std::span<const PosedImageName> images, std::span<const PointTrack> points);

}  // namespace vantage
