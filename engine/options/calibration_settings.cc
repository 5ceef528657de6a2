#include "engine/options/calibration_settings.h"

namespace vantage {

void add_kept_outline_setting(Settings& settings, RectificationOptions& rectification) {
  settings.number("kept-outline", rectification.kept_outline, "SHARE",
                  "Area of images rectified with the calibration: 0 only what both cameras see, 1 "
                  "everything, with black borders");
}

void add_kitti_cameras_setting(Settings& settings, std::optional<KittiCameras>& cameras) {
  settings.choice<KittiCameras>(
      "kitti-cameras", cameras, {{"0,1", KittiCameras::kGrey}, {"2,3", KittiCameras::kColour}},
      "Cameras of a KITTI calibration: 0,1 are grey, 2,3 colour; auto: by the folders of the "
      "images, such as image_2, else 0,1");
}

}  // namespace vantage
