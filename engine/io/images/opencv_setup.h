#pragma once

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

}  // namespace vantage
