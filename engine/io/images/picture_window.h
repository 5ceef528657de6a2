#pragma once

#include <cstdint>
#include <string>

#include "engine/image/image.h"

namespace vantage {

/// Throws UsageError, in one line, where no window can be opened: no X server answers. What
/// QT_QPA_PLATFORM names is trusted.
void require_display();

/// A window on the screen, by OpenCV's highgui, which is loaded when the first one opens. Thread
/// rule: all calls by one thread, of all windows the same: the main thread.
class PictureWindow {
 public:
  /// Throws Error where the library is missing. Call require_display() before.
  explicit PictureWindow(std::string title);
  PictureWindow(const PictureWindow&) = delete;
  PictureWindow& operator=(const PictureWindow&) = delete;
  ~PictureWindow();

  /// Shows two pictures, grey or RGB, side by side, reduced to fit usual screens.
  void show(const Image<std::uint8_t>& left, const Image<std::uint8_t>& right);
  /// Waits up to `wait_ms` and answers the user meanwhile. False: q, Esc, or the window is closed.
  bool stays_open(int wait_ms);

 private:
  std::string title_;
};

}  // namespace vantage
