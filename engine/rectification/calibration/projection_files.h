#pragma once

#include <optional>
#include <string_view>

#include "engine/rectification/calibration/camera_reading.h"

namespace vantage {

/// Two cameras of a rectified pair, each given as P = K · (I | t), without a unit. Throws Error
/// where they are at one place.
StereoCalibration from_projections(const Matrix34& left, const Matrix34& right);

/// calib.txt of Middlebury and ETH3D: cam0, cam1, baseline, width, height, and doffs, which must
/// agree with the cameras to 0.1 px. Rectified, in millimetres.
StereoCalibration from_middlebury(const CalibrationEntries& entries);

/// Whether the entries are projections of KITTI's, which counts from 0; OpenCV's P1 and P2 are not.
bool are_of_kitti(const CalibrationEntries& entries);
/// P0 and P1 (grey) or P2 and P3 (colour), or P_rect_00 …; cameras of other numbers are the first
/// two (DrivingStereo: 101 and 103). Rectified, in metres.
StereoCalibration from_kitti(const CalibrationEntries& entries,
                             std::optional<KittiCameras> cameras);

/// KITTI's odometry sequences are distributed with and without names: lines of 12 numbers. Empty
/// for any other text.
CalibrationEntries nameless_projections(std::string_view text);

}  // namespace vantage
