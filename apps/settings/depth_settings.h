#pragma once

#include <optional>
#include <span>
#include <string>

#include "apps/match/depth_outputs.h"
#include "engine/image/image.h"
#include "engine/options/rig_scale.h"
#include "engine/options/settings.h"
#include "engine/rectification/rectifier.h"
#include "engine/view_geometry/depth_resolution.h"

namespace vantage::apps {

/// Depths and their resolution (EQUATIONS §5.10), and what they are computed from.
struct DepthSettings {
  std::string resolution_file;  ///< map of δZ; empty: none
  DepthOutputs outputs;
  std::string calibration;  ///< of the images, which are rectified first if needed
  CalibrationChoice calibration_choice;
  RigScale rig;
  RectificationOptions rectification;
  std::optional<double> step_px = std::nullopt;  ///< δ; default 0.1, or 1 for whole disparities

  /// Throws UsageError where fields are wrong or do not go together.
  void validate(bool is_vertical) const;
  [[nodiscard]] bool has_geometry() const {
    return !calibration.empty() || rig.focal_length_px.has_value();
  }
};

/// What is known of the cameras of images of one size.
class DepthGeometry {
 public:
  /// Reads the calibration. Throws Error if it cannot be read, belongs to images of another size,
  /// or has no scale although an output is in metres.
  DepthGeometry(const DepthSettings& depth, int width_px, int height_px, bool is_vertical);

  /// Null unless the images must be rectified.
  [[nodiscard]] const Rectifier* rectifier() const {
    return rectifier_ && rectifier_->needs_rectification() ? &*rectifier_ : nullptr;
  }
  /// What was assumed when the calibration was read; empty without a calibration.
  [[nodiscard]] std::span<const Remark> remarks() const {
    return rectifier_ ? std::span<const Remark>(rectifier_->pair().remarks)
                      : std::span<const Remark>();
  }
  /// Of the map of one image; its unit is the metre, or that of the calibration where its length is
  /// not known, or the baseline. Empty: not even the focal length is known.
  [[nodiscard]] std::optional<MapCamera> camera(Side side) const;

 private:
  const DepthSettings& depth_;
  int width_px_;
  int height_px_;
  bool is_vertical_;
  std::optional<Rectifier> rectifier_;
  double metres_per_unit_ = 1;
};

/// Binds all of it, in a group of its own.
void add_depth_settings(Settings& settings, DepthSettings& depth);

/// For reports: δZ / Z at these disparities, and with `scale` depths too.
SettingValue depth_resolution_values(const DisparityQuantiles& disparities,
                                     const std::optional<DepthScale>& scale, double step_px);

}  // namespace vantage::apps
