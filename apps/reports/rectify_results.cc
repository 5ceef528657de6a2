#include "apps/reports/rectify_results.h"

#include <fmt/format.h>

#include <cstdio>

#include "apps/process/tell.h"
#include "apps/reports/vertical_error_report.h"
#include "engine/options/matrix_rows.h"
#include "engine/rectification/rows/row_remarks.h"
#include "engine/rectification/vertical_error.h"

namespace vantage::apps {
namespace {

/// Below this share of the photograph near points, cameras are uncertain.
constexpr double kMinCovered = 0.5;

void print_validation(const RigValidation& validation) {
  if (validation.held_out) {
    tell("rectify: row error at points that the estimate did not use: {}\n",
         vertical_error_text(*validation.held_out));
    if (!is_rectified(*validation.held_out)) {
      tell(
          "rectify: warning: away from the points, {}; more pairs of the rig, or a calibration, "
          "give better cameras\n",
          cost_text(*validation.held_out, "rows"));
    }
  }
  if (validation.covered_share < kMinCovered) {
    tell(
        "rectify: warning: points cover {:.0f} % of the image, expected at least {:.0f} %: row "
        "errors may be larger elsewhere\n",
        100 * validation.covered_share, 100 * kMinCovered);
  }
}

void print_scale(const StereoCalibration& calibration) {
  if (!calibration.has_scale) {
    tell(
        "rectify: the cameras have no scale: images alone do not show it; --baseline METRES gives "
        "it, for depths in metres\n");
  } else if (calibration.metres_per_unit) {
    tell("rectify: baseline {:.6g} m\n", calibration.baseline() * *calibration.metres_per_unit);
  }
}

}  // namespace

SettingValue results_of(const Rectification& rectification, const RectifiedPair& pair,
                        int pair_count) {
  SettingValue results = {
      {"pairs", pair_count},
      {"cameras", rectification.calibration.format},
      {"matches", rectification.matches.size()},
      {"inliers", nullptr},
      {"epipolar_rms_px", nullptr},
      {"vertical_error", nullptr},
      {"held_out_vertical_error", nullptr},
      {"covered_share", nullptr},
      {"disparities", nullptr},
      {"baseline_m", nullptr},
      {"looks_exchanged", nullptr},
      {"valid",
       {{"x", pair.valid.x},
        {"y", pair.valid.y},
        {"width", pair.valid.width},
        {"height", pair.valid.height}}},
      {"focal_length_px", pair.left.matrix(0, 0)},
      {"baseline", pair.baseline},
      {"homographies",
       {{"left", rows_of(pair.left.homography)}, {"right", rows_of(pair.right.homography)}}}};
  if (rectification.estimate) {
    results["inliers"] = rectification.estimate->inliers;
    results["epipolar_rms_px"] = rectification.estimate->rms_px;
  }
  if (rectification.validation) {
    results["covered_share"] = rectification.validation->covered_share;
    if (rectification.validation->held_out) {
      results["held_out_vertical_error"] =
          vertical_error_values(*rectification.validation->held_out);
    }
  }
  const StereoCalibration& calibration = rectification.calibration;
  if (calibration.has_scale && calibration.metres_per_unit) {
    results["baseline_m"] = calibration.baseline() * *calibration.metres_per_unit;
  }
  if (rectification.remaining) {
    results["vertical_error"] = vertical_error_values(*rectification.remaining);
    results["disparities"] = disparities_text(*rectification.remaining);
    results["looks_exchanged"] = rectification.remaining->looks_exchanged();
  }
  return results;
}

void print_results(const Rectification& rectification, const RectifiedPair& pair, int pair_count,
                   const std::string& calibration) {
  tell("rectify: {} pair{} of {}x{} pixels, {}\n", pair_count, pair_count == 1 ? "" : "s",
       pair.width_px, pair.height_px,
       rectification.estimate
           ? fmt::format("cameras estimated from {} of {} points", rectification.estimate->inliers,
                         rectification.matches.size())
           : fmt::format("cameras from {} ({})", calibration, rectification.calibration.format));
  if (rectification.remaining) {
    tell("rectify: rows are off by {}; disparities {}\n",
         vertical_error_text(*rectification.remaining), disparities_text(*rectification.remaining));
    if (rectification.validation) {
      print_validation(*rectification.validation);
    }
    if (!rectification.estimate && !is_rectified(*rectification.remaining)) {
      tell("rectify: warning: the calibration does not fit the images: {}\n",
           cost_text(*rectification.remaining, "rows"));
    }
    if (rectification.remaining->looks_exchanged()) {
      tell("rectify: warning: {}\n", exchanged_text(*rectification.remaining));
    }
  } else {
    tell("rectify: too few points in common to measure row errors\n");
  }
  print_scale(rectification.calibration);
  tell("rectify: valid region {}x{} pixels from ({}, {})\n", pair.valid.width, pair.valid.height,
       pair.valid.x, pair.valid.y);
}

}  // namespace vantage::apps
