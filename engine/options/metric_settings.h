#pragma once

#include <optional>
#include <string_view>

#include "engine/options/settings.h"
#include "engine/reprojection/point_cloud.h"

namespace vantage {

/// --disparity-resolution, in the present group, and its check, which throws UsageError.
void add_disparity_resolution_setting(Settings& settings, std::optional<double>& step_px);
void require_disparity_resolution(const std::optional<double>& step_px);

/// --max-depth.
void add_max_depth_setting(Settings& settings, std::optional<double>& max_depth_m);
/// That, and which pixels become points.
void add_cloud_settings(Settings& settings, CloudOptions& options);
/// Refuses options of points where there are none; `why` such as "without --cloud and --mesh".
void refuse_idle_cloud_options(const Settings& settings, std::string_view why);

}  // namespace vantage
