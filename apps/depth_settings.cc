#include "apps/depth_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/io/map_formats.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage::apps {
namespace {

void require_above_0(const char* option, const std::optional<double>& value) {
  if (value && !(*value > 0 && std::isfinite(*value))) {
    throw UsageError(fmt::format("{} is {}, expected a number above 0", option, *value));
  }
}

}  // namespace

void DepthSettings::validate(bool is_vertical) const {
  require_above_0("focal-length", focal_length_px);
  require_above_0("baseline-length", baseline);
  require_above_0("disparity-resolution", step_px);
  if (doffs_px && !std::isfinite(*doffs_px)) {
    throw UsageError(fmt::format("doffs is {}, expected a finite number", *doffs_px));
  }
  if (!calibration.empty() && (focal_length_px || baseline || doffs_px)) {
    throw UsageError(
        "--calibration is given with --focal-length, --baseline-length or --doffs, expected one of "
        "both: a calibration has all three");
  }
  if (!calibration.empty() && is_vertical) {
    throw UsageError(
        "--calibration is given with --vertical, expected --focal-length and --baseline-length: "
        "calibrations are of cameras side by side");
  }
  if (calibration.empty() && !focal_length_px) {
    if (baseline || doffs_px) {
      throw UsageError(fmt::format("--{} has no effect without --focal-length",
                                   baseline ? "baseline-length" : "doffs"));
    }
    if (!resolution_file.empty()) {
      throw UsageError("--depth-resolution needs --calibration or --focal-length");
    }
  }
}

std::optional<DepthScale> DepthSettings::scale(int width_px, int height_px) const {
  if (calibration.empty()) {
    return focal_length_px ? std::optional(DepthScale{.focal_length_px = *focal_length_px,
                                                      .baseline = baseline.value_or(1),
                                                      .doffs_px = doffs_px.value_or(0)})
                           : std::nullopt;
  }
  const StereoCalibration cameras = read_stereo_calibration(calibration);
  if (!cameras.is_rectified) {
    throw Error(
        fmt::format("{} is of cameras that are not rectified, expected one of rectified images; or "
                    "give --focal-length, --baseline-length and --doffs",
                    calibration));
  }
  cameras.check_image_size(width_px, height_px);
  return DepthScale{.focal_length_px = cameras.left.matrix(0, 0),
                    .baseline = cameras.baseline(),
                    .doffs_px = cameras.doffs_px()};
}

void add_depth_settings(Settings& settings, DepthSettings& depth) {
  settings.start_group("Depth");
  settings.path("depth-resolution", depth.resolution_file, "FILE",
                fmt::format("Write the distance from each pixel's depth to the next one that can "
                            "be told from it, in the unit of the baseline: {}",
                            listed_map_formats(MapContent::kConfidence)));
  settings.input_path("calibration", depth.calibration, "FILE",
                      "Calibration of the rectified images: Middlebury, KITTI or OpenCV");
  settings.number("focal-length", depth.focal_length_px, "PX",
                  "In place of a calibration: focal length of the rectified images");
  settings.number("baseline-length", depth.baseline, "B",
                  "Distance of the cameras, in the unit that depths are wanted in; auto: 1");
  settings.number("doffs", depth.doffs_px, "PX",
                  "cx of the right image minus cx of the left one; auto: 0");
  settings.number("disparity-resolution", depth.step_px, "PX",
                  "Difference of disparities that can be told apart; auto: 0.1, or 1 with "
                  "--subpixel none");
}

void report_depth_resolution(ImageView<const float> disparity_px,
                             const std::optional<DepthScale>& scale, double step_px,
                             RunReport& report) {
  std::vector<float> known;
  for (int y = 0; y < disparity_px.height(); ++y) {
    std::copy_if(disparity_px.row(y), disparity_px.row(y) + disparity_px.width(),
                 std::back_inserter(known), [](float d) { return std::isfinite(d); });
  }
  if (known.empty()) {
    return;
  }
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  const auto [smallest, largest] = std::minmax_element(known.begin(), known.end());
  const DepthScale used = scale.value_or(DepthScale{});
  SettingValue values = {{"disparity_resolution_px", step_px}};
  if (scale) {
    values["focal_length_px"] = scale->focal_length_px;
    values["baseline"] = scale->baseline;
    values["doffs_px"] = scale->doffs_px;
  }
  for (const auto& [name, disparity] :
       {std::pair{"nearest", *largest}, std::pair{"median", *middle},
        std::pair{"farthest", *smallest}}) {
    const auto at = static_cast<double>(disparity);
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
  report.add_result("depth_resolution", std::move(values));
}

}  // namespace vantage::apps
