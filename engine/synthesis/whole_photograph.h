#pragma once

#include <Eigen/Core>
#include <mutex>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/rectification/rectifier.h"

namespace vantage {

/// The rectified image extended to the whole photograph. A rectified image covers only the part
/// that the other camera sees too; views from the camera's own position show the photograph
/// everywhere and need no disparities. Made by the first call of window().
///
/// Thread rule: may be used concurrently.
class WholePhotograph {
 public:
  /// Valid as long as the WholePhotograph. Both images have the same size, at most three times that
  /// of the rectified image in either direction.
  struct Window {
    Eigen::Vector2d first_px;       ///< rectified position of its first pixel, ≤ 0
    PhotographPositions positions;  ///< of its pixels
    /// 0 where the photograph covers the whole pixel (disparity of points at infinity), else NaN.
    ImageView<const float> disparity_px;
    /// Disparities of the photograph's pixels: 0.
    ImageView<const float> photograph_disparity_px;
  };

  /// `rectifier` must need rectification; it and `execution` outlive the WholePhotograph.
  WholePhotograph(const Rectifier& rectifier, Side side, Execution& execution);

  [[nodiscard]] const Window& window() const;

 private:
  void make_window() const;

  const Rectifier& rectifier_;
  Side side_;
  Execution& execution_;
  mutable std::once_flag is_made_;
  mutable Image<float> x_px_;
  mutable Image<float> y_px_;
  mutable Image<float> disparity_px_;
  mutable Image<float> zeros_;  // one row
  mutable Window window_;
};

}  // namespace vantage
