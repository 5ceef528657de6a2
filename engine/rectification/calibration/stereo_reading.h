#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/rectification/calibration/camera_reading.h"
#include "engine/rectification/calibration/posed_images.h"

namespace vantage {

/// Which cameras are wanted of a file that has those of photographs and of rectified images.
enum class CameraChoice { kPhotographs, kRectified };

// `file` is the name for messages; the results are not validated.

/// Two cameras of one list of entries. Where the second one stands, the first of these tells: R and
/// T, Stereo.T_c1_c2, T_cn_cnm1, T_BS or T_cam_imu of both, R1, P1, R2 and P2, Camera.bf, a
/// baseline; in metres, but for R and T, projections without Camera.bf, and a baseline. Throws
/// Error for what is missing or wrong.
StereoCalibration from_names(const CalibrationNames& names, CameraChoice cameras,
                             const CalibrationChoice& choice, const std::string& file);

/// Whether the entries are of one camera, and do not say which.
bool are_of_one_camera(const CalibrationNames& names);
/// Of two files of one camera each.
StereoCalibration from_two_cameras(const std::array<CalibrationNames, 2>& names,
                                   CameraChoice cameras, const CalibrationChoice& choice,
                                   const std::string& file);
/// Of the file of the right camera alone: its projection tells all of a rectified pair.
StereoCalibration from_right_camera(const CalibrationNames& names, CameraChoice cameras);

/// Of a model with two images. The one to the left is the left one; the unit is not known.
StereoCalibration from_posed_images(const std::vector<PosedImage>& images, const std::string& file);

}  // namespace vantage
