#pragma once

#include <optional>
#include <string>

#include "apps/run_report.h"
#include "apps/settings.h"
#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/view_geometry/depth_resolution.h"

namespace vantage::apps {

/// What depths and their resolution are computed from (EQUATIONS §5.10).
struct DepthSettings {
  std::string resolution_file;  ///< map of δZ; empty: none
  std::string calibration;      ///< of the rectified images; empty: the numbers below
  std::optional<double> focal_length_px = std::nullopt;
  std::optional<double> baseline = std::nullopt;  ///< default 1: depths are in baselines
  std::optional<double> doffs_px = std::nullopt;  ///< default 0
  std::optional<double> step_px = std::nullopt;   ///< δ; default 0.1, or 1 for whole disparities

  /// Throws UsageError where fields are wrong or do not go together.
  void validate(bool is_vertical) const;
  /// The scale of images of this size. Empty: the focal length is not known. Throws Error if the
  /// calibration cannot be read, or belongs to images of another size.
  [[nodiscard]] std::optional<DepthScale> scale(int width_px, int height_px) const;
};

/// Binds all of it, in a group of its own.
void add_depth_settings(Settings& settings, DepthSettings& depth);

/// δZ / Z at the nearest, the median and the farthest known disparity of a map, and with `scale`
/// depths too: for reports, under the key `depth_resolution`. Nothing if no disparity is known.
void report_depth_resolution(ImageView<const float> disparity_px,
                             const std::optional<DepthScale>& scale, double step_px,
                             RunReport& report);

}  // namespace vantage::apps
