#include "apps/inputs/kitti_cameras_choice.h"

#include <string_view>

#include "apps/process/tell.h"

namespace vantage::apps {
namespace {

std::string_view numbers_of(KittiCameras cameras) {
  return cameras == KittiCameras::kGrey ? "0 and 1" : "2 and 3";
}

void tell_of_grey_cameras(const Settings& settings, const std::string& calibration) {
  tell(
      "{}: warning: {}: has KITTI's cameras 0 to 3, and 0 and 1 (grey) are used; "
      "--kitti-cameras 2,3 for images of 2 and 3 (colour)\n",
      settings.command(), calibration);
}

}  // namespace

void choose_kitti_cameras(const Settings& settings, const CommonOptions& common,
                          const std::string& calibration,
                          std::span<const std::filesystem::path> images,
                          CalibrationChoice& choice) {
  std::optional<KittiCameras>& cameras = choice.kitti_cameras;
  if (calibration.empty() || cameras) {
    return;
  }
  // Also reads OpenCV files with only P1 and P2, or only Q: cameras of rectified images.
  const StereoCalibration read = read_stereo_calibration(calibration, choice);
  if (!read.kitti_cameras) {
    return;
  }
  const std::optional<KittiCameras> named = kitti_cameras_of(images);
  cameras = read.has_other_cameras && named ? named : read.kitti_cameras;
  if (common.quiet) {
    return;
  }
  if (named && named != cameras) {
    tell(
        "{}: warning: {}: has only KITTI's cameras {}, but the folders of the images are those of "
        "{}\n",
        settings.command(), calibration, numbers_of(*cameras), numbers_of(*named));
  } else if (read.has_other_cameras && named) {
    tell("{}: --kitti-cameras auto is {}\n", settings.command(),
         cameras == KittiCameras::kGrey ? "0,1" : "2,3");
  } else if (read.has_other_cameras) {
    tell_of_grey_cameras(settings, calibration);
  }
}

void warn_of_grey_cameras(const Settings& settings, const CommonOptions& common,
                          const ListColumns& columns, const CalibrationChoice& choice) {
  if (choice.kitti_cameras || common.quiet) {
    return;
  }
  for (const auto& [file, named] : columns.calibrations) {
    if (!named && read_stereo_calibration(file, choice).has_other_cameras) {
      tell_of_grey_cameras(settings, file.string());
      return;
    }
  }
}

}  // namespace vantage::apps
