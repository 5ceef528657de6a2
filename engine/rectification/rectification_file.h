#pragma once

#include <filesystem>
#include <string>

#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// True for .yml, .yaml, .xml and .json.
bool is_rectification_extension(const std::filesystem::path& path);

/// Text of an OpenCV file (cv::FileStorage: .yml, .yaml, .xml or .json, by the extension) with the
/// complete rectification, under the names of OpenCV's samples: image_width, image_height; M1, D1,
/// M2, D2, R, T, the original cameras (read_stereo_calibration() reads them back), with
/// fisheye_model1 and fisheye_model2, 0 or 1, where D has four coefficients; R1, R2, P1, P2, Q as
/// from cv::stereoRectify; H1, H2, rectified pixel ← undistorted pixel; baseline, doffs,
/// valid_region (x, y, width, height), and metres_per_unit (0: no scale) if known. Throws
/// UsageError for another extension. Thread rule: may be called concurrently.
std::string rectification_text(const std::filesystem::path& path,
                               const StereoCalibration& calibration, const RectifiedPair& pair);

}  // namespace vantage
