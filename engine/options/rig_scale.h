#pragma once

#include <array>
#include <optional>
#include <string>

#include "engine/image/side.h"
#include "engine/options/settings.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/stereo_calibration.h"
#include "engine/reprojection/map_camera.h"

namespace vantage {

/// What turns disparities into metres, beside or in place of a calibration.
struct RigScale {
  bool images_are_rectified = false;  ///< although the calibration is of cameras that are not
  std::optional<double> focal_length_px = std::nullopt;
  std::optional<double> baseline_m = std::nullopt;
  std::optional<double> doffs_px = std::nullopt;  ///< default 0
  /// Of the left image; default: the middle of the image.
  std::optional<std::array<double, 2>> principal_point_px = std::nullopt;
  std::optional<double> metres_per_unit = std::nullopt;  ///< of the calibration

  /// Whether fields stand in place of a calibration.
  [[nodiscard]] bool replaces_calibration() const {
    return focal_length_px || doffs_px || principal_point_px;
  }
  /// Throws UsageError where fields are wrong or do not go together. `calibration` is the path to
  /// the file, or empty.
  void validate(const std::string& calibration) const;
  /// Throws UsageError if metres cannot be had, whatever the calibration says: `option` needs them.
  void require_given(const std::string& calibration, const std::string& option) const;

  /// Reads the calibration of the images. A baseline that no rig has is among its remarks. Throws
  /// Error.
  [[nodiscard]] StereoCalibration read(const std::string& calibration,
                                       const CalibrationChoice& choice) const;
  /// Metres per unit of a calibration, of its file or from these settings. Empty: not known.
  [[nodiscard]] std::optional<double> unit_of(const StereoCalibration& calibration) const;
  /// The same; throws Error naming the file if not known.
  [[nodiscard]] double required_unit_of(const StereoCalibration& calibration) const;

  /// The camera of a map of images of this size, without a calibration. `is_vertical`: the right
  /// camera is below the left one. Needs the focal length; the baseline is 1 if not given.
  [[nodiscard]] MapCamera camera(int width_px, int height_px, Side side, bool is_vertical) const;
};

/// What the cameras are for: depths do not depend on the principal point.
enum class RigUse { kPoints, kDepths };

/// Binds all of it that is of use, in the present group.
void add_rig_scale_settings(Settings& settings, RigScale& scale, RigUse use = RigUse::kPoints);

}  // namespace vantage
