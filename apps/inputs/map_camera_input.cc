#include "apps/inputs/map_camera_input.h"

namespace vantage::apps {

void MapCameraInput::validate(const Settings& settings) const {
  rig.validate(calibration);
  rectification.validate();
  if (calibration.empty()) {
    settings.refuse_idle({"kept-outline", "kitti-cameras", "lens"}, "without --calibration");
  }
}

MapCamera MapCameraInput::camera(int width_px, int height_px, Side side,
                                 std::vector<Remark>* remarks) const {
  if (calibration.empty()) {
    return rig.camera(width_px, height_px, side, false);
  }
  const StereoCalibration cameras = rig.read(calibration, calibration_choice);
  const RectifiedPair pair = rectified_pair(cameras, width_px, height_px, rectification);
  if (remarks != nullptr) {
    *remarks = pair.remarks;
  }
  return map_camera(pair, side, rig.required_unit_of(cameras));
}

void add_map_camera_settings(Settings& settings, MapCameraInput& cameras, RigUse use) {
  settings.input_path("calibration", cameras.calibration, "FILE",
                      "Cameras of the pair, or of the photographs that it was rectified from: "
                      "file of OpenCV, KITTI or another tool, or two (A,B)");
  add_kept_outline_setting(settings, cameras.rectification);
  add_calibration_choice_settings(settings, cameras.calibration_choice);
  add_rig_scale_settings(settings, cameras.rig, use);
}

}  // namespace vantage::apps
