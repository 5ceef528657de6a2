#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "apps/settings/common_options.h"
#include "engine/jobs/list_columns.h"
#include "engine/options/settings.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage::apps {

/// Where KITTI's cameras are not chosen and the calibration has both pairs of KITTI's cameras:
/// chooses those that the folders of `images` name, else to the grey ones, and tells which on
/// stderr. Does nothing for other calibrations, or without one. Throws Error if it cannot be read.
void choose_kitti_cameras(const Settings& settings, const CommonOptions& common,
                          const std::string& calibration,
                          std::span<const std::filesystem::path> images, CalibrationChoice& choice);

/// Warns once where pairs of a list have calibrations of both pairs of KITTI's cameras, and neither
/// `choice` nor the folders of their images say which: the grey ones are used.
void warn_of_grey_cameras(const Settings& settings, const CommonOptions& common,
                          const ListColumns& columns, const CalibrationChoice& choice);

}  // namespace vantage::apps
