#include "engine/io/images/opencv_codecs.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "engine/late_library.h"

namespace vantage {
namespace {

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
