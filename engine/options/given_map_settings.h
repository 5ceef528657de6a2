#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/options/settings.h"
#include "engine/remark.h"
#include "engine/view_geometry/depth_resolution.h"

namespace vantage {

enum class MapQuantity { kDisparity, kDepth };

/// What the files of maps hold that a user gives, and in which unit.
struct GivenMapOptions {
  MapQuantity quantity = MapQuantity::kDisparity;
  std::optional<double> disparity_scale = std::nullopt;  ///< integers per pixel
  std::optional<double> depth_scale = std::nullopt;      ///< values per metre

  [[nodiscard]] bool holds_depths() const { return quantity == MapQuantity::kDepth; }
  /// Throws UsageError for a scale that is wrong or that nothing reads.
  void validate(const Settings& settings) const;
};

/// --given, --disparity-scale and --depth-scale, in the present group.
void add_given_map_settings(Settings& settings, GivenMapOptions& options);

/// Reads a map; depths become disparities of the camera that `camera` returns for the map's size
/// (baseline in metres). `remarks` gets what was assumed. Throws Error and UsageError as
/// read_disparity() and read_depth().
DisparityMap read_given_map(const std::string& path, const GivenMapOptions& options,
                            const std::function<DepthScale(int width_px, int height_px)>& camera,
                            Execution& execution, std::vector<Remark>& remarks);

}  // namespace vantage
