#include "engine/options/rig_scale.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/error.h"

namespace vantage {
namespace {

void add_principal_point(Settings& settings, std::optional<std::array<double, 2>>& point) {
  constexpr const char* kAutomatic = "auto";
  Setting& setting = settings.add("principal-point", "CX,CY",
                                  "In place of a calibration: principal point of the left image in "
                                  "pixels; auto: the middle of the image");
  setting.kind = ValueKind::kPoint;
  setting.words = {kAutomatic};
  setting.set = [&point](const SettingValue& value) {
    if (value == kAutomatic) {
      point.reset();
      return;
    }
    point = from_parts(value, ',', 2, "two numbers of pixels such as 319.5,239.5, or auto",
                       [](const auto& parts) {
                         return std::optional(std::array{to_number(parts[0]), to_number(parts[1])});
                       });
  };
  setting.get = [&point]() -> SettingValue {
    return point ? fmt::format("{},{}", (*point)[0], (*point)[1]) : std::string(kAutomatic);
  };
}

}  // namespace

void RigScale::validate(const std::string& calibration) const {
  require_above_0("focal-length", focal_length_px);
  require_above_0("baseline", baseline_m);
  if (doffs_px && !std::isfinite(*doffs_px)) {
    throw UsageError(fmt::format("--doffs is {}, expected a finite number", *doffs_px));
  }
  if (!calibration.empty()) {
    if (replaces_calibration()) {
      throw UsageError(
          "--calibration is given with --focal-length, --doffs or --principal-point, expected one "
          "of both: a calibration has all three");
    }
    if (baseline_m && metres_per_unit) {
      throw UsageError(
          "--baseline and --calibration-unit are both given, expected one of them: both say how "
          "long the unit of the calibration is");
    }
    return;
  }
  if (metres_per_unit || images_are_rectified) {
    throw UsageError(fmt::format("--{} has no effect without --calibration",
                                 metres_per_unit ? "calibration-unit" : "already-rectified"));
  }
  if (!focal_length_px && (baseline_m || doffs_px || principal_point_px)) {
    throw UsageError(fmt::format("--{} has no effect without --focal-length{}",
                                 baseline_m ? "baseline"
                                 : doffs_px ? "doffs"
                                            : "principal-point",
                                 baseline_m ? " or --calibration" : ""));
  }
}

void RigScale::require_given(const std::string& calibration, const std::string& option) const {
  if (calibration.empty() && !(focal_length_px && baseline_m)) {
    throw UsageError(fmt::format("--{} is in metres and needs {}", option,
                                 focal_length_px
                                     ? "--baseline METRES beside --focal-length"
                                     : "--calibration, or --focal-length and --baseline"));
  }
}

StereoCalibration RigScale::read(const std::string& calibration,
                                 const CalibrationChoice& choice) const {
  StereoCalibration result = images_are_rectified ? read_rectified_calibration(calibration, choice)
                                                  : read_stereo_calibration(calibration, choice);
  if (images_are_rectified && !result.is_rectified) {
    throw Error(
        fmt::format("{}: has no cameras of rectified images, expected P1 and P2, or Q, with "
                    "--already-rectified",
                    calibration));
  }
  constexpr double kShortest = 5e-4;  // metres
  constexpr double kLongest = 20;
  const std::optional<double> unit = unit_of(result);
  if (unit && !(*unit * result.baseline() >= kShortest && *unit * result.baseline() <= kLongest)) {
    result.remarks.push_back(
        {.kind = Remark::Kind::kWarning,
         .subject = "calibration",
         .text = fmt::format("{}: the baseline is {:.4g} m: is its unit another one? "
                             "`calibration-unit` m, cm or mm says which",
                             calibration, *unit * result.baseline())});
  }
  return result;
}

std::optional<double> RigScale::unit_of(const StereoCalibration& calibration) const {
  if (baseline_m) {
    return *baseline_m / calibration.baseline();
  }
  if (!calibration.has_scale) {
    return std::nullopt;
  }
  return metres_per_unit ? metres_per_unit : calibration.metres_per_unit;
}

double RigScale::required_unit_of(const StereoCalibration& calibration) const {
  const std::optional<double> unit = unit_of(calibration);
  if (unit) {
    return *unit;
  }
  throw Error(calibration.has_scale
                  ? fmt::format("{}: does not say how long its unit is, expected "
                                "--calibration-unit m, cm or mm, or --baseline METRES",
                                calibration.file)
                  : fmt::format("{}: has no scale, because its cameras were estimated from images; "
                                "expected --baseline METRES, the distance of the cameras",
                                calibration.file));
}

MapCamera RigScale::camera(int width_px, int height_px, Side side, bool is_vertical) const {
  const double baseline = baseline_m.value_or(1);
  const double doffs = doffs_px.value_or(0);
  std::array<double, 2> centre =
      principal_point_px.value_or(std::array{(width_px - 1) / 2.0, (height_px - 1) / 2.0});
  MapCamera result{
      .scale = {.focal_length_px = *focal_length_px, .baseline = baseline, .doffs_px = doffs}};
  if (side == Side::kRight) {
    const std::size_t along = is_vertical ? 1 : 0;
    centre[along] += doffs;
    result.centre[is_vertical ? 1 : 0] = baseline;
  }
  result.matrix << *focal_length_px, 0, centre[0], 0, *focal_length_px, centre[1], 0, 0, 1;
  return result;
}

void add_rig_scale_settings(Settings& settings, RigScale& scale, RigUse use) {
  settings.flag("already-rectified", scale.images_are_rectified,
                "The images were rectified with the calibration before: use its P1 and P2, or Q");
  settings.choice<double>(
      "calibration-unit", scale.metres_per_unit, {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}},
      "Unit of the calibration's lengths; auto: mm for Middlebury, m for KITTI, "
      "metres_per_unit of OpenCV files");
  settings.number("focal-length", scale.focal_length_px, "PX",
                  "In place of a calibration: focal length of the rectified images");
  if (use == RigUse::kPoints) {
    add_principal_point(settings, scale.principal_point_px);
  }
  settings.number("baseline", scale.baseline_m, "METRES",
                  "Distance of the cameras: in place of a calibration, or for one without a scale");
  settings.number("doffs", scale.doffs_px, "PX",
                  "cx of the right image minus cx of the left one; auto: 0");
}

}  // namespace vantage
