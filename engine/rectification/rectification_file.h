#pragma once

#include <filesystem>
#include <string>

#include "engine/rectification/rectified_pair.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage {

/// True for .yml, .yaml, .xml and .json.
bool is_rectification_extension(const std::filesystem::path& path);

/// A file of OpenCV's (cv::FileStorage: .yml, .yaml, .xml or .json by the name's extension) that
/// says all about a rectification, under the names that OpenCV's samples use: image_width,
/// image_height; M1, D1, M2, D2, R, T, the cameras as photographed (read_stereo_calibration() reads
/// them back from YAML and XML); R1, R2, P1, P2, Q as of cv::stereoRectify; H1, H2, rectified pixel
/// ← pixel freed of distortion; baseline, doffs, and valid_region (x, y, width, height).
/// The text of the file. Throws UsageError for another extension.
std::string rectification_text(const std::filesystem::path& path,
                               const StereoCalibration& calibration, const RectifiedPair& pair);

}  // namespace vantage
