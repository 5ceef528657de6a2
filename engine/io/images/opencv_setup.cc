#include "engine/io/images/opencv_setup.h"

#include <atomic>
#include <cstdlib>
#include <iostream>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <streambuf>
#include <string_view>

#include "engine/late_library.h"

namespace vantage {
namespace {

std::atomic<bool> is_host_of_opencv =
    true;                          // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
thread_local int quiet_depth = 0;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

/// Forwards the output of threads that are not quiet to another buffer.
class ThreadFilter : public std::streambuf {
 public:
  explicit ThreadFilter(std::streambuf* target) : target_(target) {}

 protected:
  int_type overflow(int_type c) override {
    if (quiet_depth > 0 || traits_type::eq_int_type(c, traits_type::eof())) {
      return traits_type::not_eof(c);
    }
    return target_->sputc(traits_type::to_char_type(c));
  }
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    return quiet_depth > 0 ? count : target_->sputn(text, count);
  }
  int sync() override { return quiet_depth > 0 ? 0 : target_->pubsync(); }

 private:
  std::streambuf* target_;
};

// The names are the Itanium C++ ABI names of these declarations; the types fail to compile when
// OpenCV no longer declares such functions.
using Imdecode = decltype(static_cast<cv::Mat (*)(cv::InputArray, int, cv::Mat*)>(&cv::imdecode));
constexpr const char* kImdecode = "_ZN2cv8imdecodeERKNS_11_InputArrayEiPNS_3MatE";
using Imencode =
    decltype(static_cast<bool (*)(const std::string&, cv::InputArray, std::vector<std::uint8_t>&,
                                  const std::vector<int>&)>(&cv::imencode));
constexpr const char* kImencode =
    "_ZN2cv8imencodeERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKNS_11_InputArrayE"
    "RSt6vectorIhSaIhEERKSB_IiSaIiEE";

const LateLibrary& image_codecs() {
  static const LateLibrary library(VANTAGE_IMGCODECS_LIBRARY,
                                   "cannot read or write images of this format");
  return library;
}

}  // namespace

void prepare_opencv() {
  static const bool prepared = [] {
    // OpenCV reads this when it first opens such a file. A value set by the user is kept.
    ::setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
    if (is_host_of_opencv) {
      cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
      // GDAL, which reads some TIFFs, would print its own errors.
      ::setenv("CPL_LOG", "/dev/null", 0);
      // cv::error() would print every exception before throwing it.
      cv::redirectError([](int code, const char*, const char*, const char* file, int, void*) {
        // The destructor of a buffer area asserts that it got its memory.
        if (code == cv::Error::StsNoMem || std::string_view(file).ends_with("buffer_area.cpp")) {
          throw std::bad_alloc();  // as everywhere else
        }
        return 0;
      });
      cv::setNumThreads(1);
    }
    if (std::cerr.rdbuf() != nullptr) {
      // Never freed: std::cerr is used until the process ends.
      std::cerr.rdbuf(new ThreadFilter(std::cerr.rdbuf()));
    }
    return true;
  }();
  (void)prepared;
}

void leave_opencv_to_host() { is_host_of_opencv = false; }

QuietOpenCv::QuietOpenCv() { ++quiet_depth; }
QuietOpenCv::~QuietOpenCv() { --quiet_depth; }

void decode_by_opencv(const cv::Mat& encoded, cv::Mat& decoded) {
  static const auto imdecode = image_codecs().function<Imdecode>(kImdecode);
  imdecode(encoded, cv::IMREAD_UNCHANGED, &decoded);
}

bool encode_by_opencv(const std::string& extension, const cv::Mat& pixels,
                      std::vector<std::uint8_t>& bytes, const std::vector<int>& parameters) {
  static const auto imencode = image_codecs().function<Imencode>(kImencode);
  return imencode(extension, pixels, bytes, parameters);
}

}  // namespace vantage
