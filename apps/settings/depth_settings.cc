#include "apps/settings/depth_settings.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "engine/error.h"
#include "engine/io/maps/map_formats.h"
#include "engine/options/calibration_settings.h"
#include "engine/options/metric_settings.h"

namespace vantage::apps {

void DepthSettings::validate(bool is_vertical) const {
  require_disparity_resolution(step_px);
  rig.validate(calibration);
  rectification.validate();
  if (!calibration.empty() && is_vertical) {
    throw UsageError(
        "--calibration is given with --vertical, expected --focal-length and --baseline: "
        "calibrations are of cameras side by side");
  }
  if (!resolution_file.empty() && !has_geometry()) {
    throw UsageError("--depth-resolution needs --calibration or --focal-length");
  }
  if (outputs.any()) {
    rig.require_given(calibration, outputs.first_option());
  }
}

DepthGeometry::DepthGeometry(const DepthSettings& depth, int width_px, int height_px,
                             bool is_vertical)
    : depth_(depth), width_px_(width_px), height_px_(height_px), is_vertical_(is_vertical) {
  if (depth.calibration.empty()) {
    return;
  }
  const StereoCalibration cameras = depth.rig.read(depth.calibration, depth.calibration_choice);
  metres_per_unit_ = depth.outputs.any() ? depth.rig.required_unit_of(cameras)
                                         : depth.rig.unit_of(cameras).value_or(1);
  rectifier_.emplace(cameras, width_px, height_px, depth.rectification);
}

std::optional<MapCamera> DepthGeometry::camera(Side side) const {
  if (rectifier_) {
    return map_camera(rectifier_->pair(), side, metres_per_unit_);
  }
  return depth_.rig.focal_length_px
             ? std::optional(depth_.rig.camera(width_px_, height_px_, side, is_vertical_))
             : std::nullopt;
}

void add_depth_settings(Settings& settings, DepthSettings& depth) {
  settings.start_group("Depth, in metres");
  settings.input_path(
      "calibration", depth.calibration, "FILE",
      "Cameras, to rectify the pair first if needed, and for depths: file of OpenCV, "
      "KITTI or another tool, or two (A,B)");
  add_kept_outline_setting(settings, depth.rectification);
  add_calibration_choice_settings(settings, depth.calibration_choice);
  add_rig_scale_settings(settings, depth.rig);
  add_depth_output_settings(settings, depth.outputs);
  add_cloud_settings(settings, depth.outputs.options);
  settings.path(
      "depth-resolution", depth.resolution_file, "FILE",
      fmt::format(
          "Write the depth resolution, the distance from each pixel's depth to the next that can "
          "be distinguished from it, in metres, or in the calibration's unit where that is not "
          "known: {}",
          listed_map_formats(MapContent::kConfidence)));
  add_disparity_resolution_setting(settings, depth.step_px);
}

SettingValue depth_resolution_values(const DisparityQuantiles& disparities,
                                     const std::optional<DepthScale>& scale, double step_px) {
  const DepthScale used = scale.value_or(DepthScale{});
  SettingValue values = {{"disparity_resolution_px", step_px}};
  if (scale) {
    values["focal_length_px"] = scale->focal_length_px;
    values["baseline"] = scale->baseline;
    values["doffs_px"] = scale->doffs_px;
  }
  for (const auto& [name, disparity_px] :
       {std::pair{"nearest", disparities.nearest_px}, std::pair{"median", disparities.median_px},
        std::pair{"farthest", disparities.farthest_px}}) {
    const auto at = static_cast<double>(disparity_px);
    const auto depth_there = depth(used, at);
    const auto resolution = depth_resolution(used, step_px, at);
    SettingValue entry = {{"disparity_px", at}};
    if (scale && depth_there) {
      entry["depth"] = *depth_there;
    }
    if (resolution) {
      entry["relative_resolution"] = *resolution / *depth_there;
      if (scale) {
        entry["depth_resolution"] = *resolution;
      }
    }
    values[name] = std::move(entry);
  }
  return values;
}

}  // namespace vantage::apps
