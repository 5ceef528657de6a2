#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cv {
class Mat;
}

namespace vantage {

/// Prepares OpenCV for use by an engine with its own threads and error messages: no threads
/// underneath, no text on stderr (its errors reach the user as ours), EXR enabled. The first call
/// applies to the whole process. Thread rule: may be called concurrently.
void prepare_opencv();

/// For libraries in a process that uses OpenCV itself: from now on prepare_opencv() leaves OpenCV's
/// threads, log level and error handler as they are. Call it before anything else.
void leave_opencv_to_host();

/// During its lifetime, output of its thread to std::cerr is dropped: OpenCV's decoders print the
/// exceptions that they turn into an empty image. Call prepare_opencv() first. May be nested.
class QuietOpenCv {
 public:
  QuietOpenCv();
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;
  ~QuietOpenCv();
};

// OpenCV's image codecs. Their library loads 120 others, so it is opened by the first call of these
// functions and not at program start. Thread rule: both may be called concurrently.

/// cv::imdecode() with IMREAD_UNCHANGED; `decoded` is empty when it cannot be decoded. Throws
/// cv::Exception as cv::imdecode() does, and Error when the library cannot be opened.
void decode_by_opencv(const cv::Mat& encoded, cv::Mat& decoded);

/// cv::imencode(): the same extensions, order of channels, parameters and result. Throws likewise.
bool encode_by_opencv(const std::string& extension, const cv::Mat& pixels,
                      std::vector<std::uint8_t>& bytes, const std::vector<int>& parameters = {});

}  // namespace vantage
