#include "engine/options/calibration_settings.h"

namespace vantage {

void add_kept_outline_setting(Settings& settings, RectificationOptions& rectification) {
  settings.number("kept-outline", rectification.kept_outline, "SHARE",
                  "Area of images rectified with the calibration: 0 only what both cameras see, 1 "
                  "everything, with black borders");
}

void add_calibration_choice_settings(Settings& settings, CalibrationChoice& choice) {
  settings.choice<KittiCameras>(
      "kitti-cameras", choice.kitti_cameras,
      {{"0,1", KittiCameras::kGrey}, {"2,3", KittiCameras::kColour}},
      "Cameras of a KITTI calibration: 0,1 are grey, 2,3 colour; auto: by the folders of the "
      "images, such as image_2, else 0,1");
  add_lens_setting(settings, choice.lens);
}

void add_lens_setting(Settings& settings, std::optional<LensKind>& lens) {
  settings.choice<LensKind>(
      "lens", lens, {{"standard", LensKind::kStandard}, {"fisheye", LensKind::kFisheye}},
      "What four distortion coefficients are: standard, k1 k2 p1 p2, or fisheye, k1 k2 k3 k4 of "
      "cv2.fisheye; auto: what the calibration says");
}

}  // namespace vantage
