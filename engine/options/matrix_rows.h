#pragma once

#include "engine/options/setting_value.h"
#include "engine/view_geometry/posed_camera.h"

namespace vantage {

/// The matrix as files of poses and reports have it: an array of three rows.
SettingValue rows_of(const Eigen::Matrix3d& matrix);

}  // namespace vantage
