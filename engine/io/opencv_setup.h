#pragma once

namespace vantage {

/// Prepares OpenCV for use by an engine with threads and error messages of its own: no threads
/// underneath, no text on stderr (its errors reach the user as ours), EXR switched on. The first
/// call does it, for the whole process. Thread rule: may be called concurrently.
void prepare_opencv();

/// While one lives, what its thread writes to std::cerr is dropped: OpenCV's decoders print the
/// exceptions that they turn into an empty image. prepare_opencv() comes first. May be nested.
class QuietOpenCv {
 public:
  QuietOpenCv();
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;
  ~QuietOpenCv();
};

}  // namespace vantage
