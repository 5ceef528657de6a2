#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cv {
class Mat;
}

namespace vantage {

// OpenCV's image codecs. Their library loads 120 others, so it is opened by the first call of these
// functions and not at program start. Thread rule: both may be called concurrently.

/// cv::imdecode() with IMREAD_UNCHANGED; `decoded` is empty when it cannot be decoded. Throws
/// cv::Exception as cv::imdecode() does, and Error when the library cannot be opened.
void decode_by_opencv(const cv::Mat& encoded, cv::Mat& decoded);

/// cv::imencode(): the same extensions, order of channels, parameters and result. Throws likewise.
bool encode_by_opencv(const std::string& extension, const cv::Mat& pixels,
                      std::vector<std::uint8_t>& bytes, const std::vector<int>& parameters = {});

}  // namespace vantage
