#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/image/side.h"
#include "engine/options/calibration_settings.h"
#include "engine/options/rig_scale.h"
#include "engine/options/settings.h"
#include "engine/reprojection/map_camera.h"

namespace vantage::apps {

/// The cameras of a map that is read from a file: of a calibration, or numbers in its place.
struct MapCameraInput {
  std::string calibration;  ///< file; empty: none
  CalibrationChoice calibration_choice;
  RectificationOptions rectification;
  RigScale rig;

  /// Throws UsageError where the options do not go together.
  void validate(const Settings& settings) const;
  /// The camera of a map of this size, in metres. `remarks` gets what was
  /// assumed, unless it is null. Throws Error where the calibration cannot be
  /// read or has no scale.
  [[nodiscard]] MapCamera camera(int width_px, int height_px, Side side,
                                 std::vector<Remark>* remarks = nullptr) const;
};

/// --calibration and what stands beside or in place of it, in the present group.
void add_map_camera_settings(Settings& settings, MapCameraInput& cameras, RigUse use);

}  // namespace vantage::apps
