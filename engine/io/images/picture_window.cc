#include "engine/io/images/picture_window.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/highgui.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "engine/error.h"
#include "engine/io/images/opencv_setup.h"
#include "engine/late_library.h"

namespace vantage {
namespace {

constexpr int kMaxWidth_px = 1600;
constexpr int kEscape = 27;

// OpenCV names its libraries so. The names below are the Itanium C++ ABI names of functions of
// these types.
const LateLibrary& highgui() {
  static const LateLibrary library(
      fmt::format("libopencv_highgui.so.{}{:02}", CV_VERSION_MAJOR, CV_VERSION_MINOR),
      "cannot open a window");
  return library;
}

cv::Mat bgr_of(const Image<std::uint8_t>& image, int height) {
  const cv::Mat pixels(image.height(), image.width(), CV_8UC(image.channels()),
                       const_cast<std::uint8_t*>(image.row(0)), image.view().stride());
  cv::Mat bgr;
  cv::cvtColor(pixels, bgr, image.channels() == 1 ? cv::COLOR_GRAY2BGR : cv::COLOR_RGB2BGR);
  cv::resize(bgr, bgr, {std::max(1, image.width() * height / image.height()), height}, 0, 0,
             cv::INTER_AREA);
  return bgr;
}

}  // namespace

void require_display() {
  if (std::getenv("QT_QPA_PLATFORM") != nullptr) {
    return;
  }
  // Qt would end the process.
  static const LateLibrary xcb("libxcb.so.1", "cannot open a window");
  void* const connection =
      xcb.function<void* (*)(const char*, int*)>("xcb_connect")(nullptr, nullptr);
  const bool is_refused = xcb.function<int (*)(void*)>("xcb_connection_has_error")(connection) != 0;
  xcb.function<void (*)(void*)>("xcb_disconnect")(connection);
  if (is_refused) {
    const char* const display = std::getenv("DISPLAY");
    throw UsageError(fmt::format("`show` needs a screen, but {}; expected a desktop, or ssh -X",
                                 display == nullptr
                                     ? "DISPLAY is not set"
                                     : fmt::format("DISPLAY {} does not answer", display)));
  }
}

PictureWindow::PictureWindow(std::string title) : title_(std::move(title)) {
  prepare_opencv();
  ::setenv("QT_LOGGING_RULES", "*.warning=false", 0);  // Qt's remarks on its surroundings
  static const auto named_window = highgui().function<decltype(&cv::namedWindow)>(
      "_ZN2cv11namedWindowERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEi");
  named_window(title_, cv::WINDOW_AUTOSIZE | cv::WINDOW_GUI_NORMAL);
}

PictureWindow::~PictureWindow() {
  static const auto destroy_windows =
      highgui().function<decltype(&cv::destroyAllWindows)>("_ZN2cv17destroyAllWindowsEv");
  destroy_windows();
}

void PictureWindow::show(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right) {
  static const auto imshow = highgui().function<void (*)(const std::string&, cv::InputArray)>(
      "_ZN2cv6imshowERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKNS_11_InputArrayE");
  const int height =
      std::min(left.height(), left.height() * kMaxWidth_px / (2 * std::max(left.width(), 1)));
  cv::Mat both;
  cv::hconcat(bgr_of(left, height), bgr_of(right, height), both);
  imshow(title_, both);
}

bool PictureWindow::stays_open(int wait_ms) {
  static const auto wait_key = highgui().function<decltype(&cv::waitKey)>("_ZN2cv7waitKeyEi");
  static const auto property = highgui().function<decltype(&cv::getWindowProperty)>(
      "_ZN2cv17getWindowPropertyERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEEi");
  const int key = wait_key(wait_ms);
  return key != kEscape && key != 'q' && property(title_, cv::WND_PROP_VISIBLE) > 0;
}

}  // namespace vantage
