#pragma once

namespace vantage {

/// A rectangle of pixels.
struct ImageRegion {
  int x_px = 0;  ///< of its first column
  int y_px = 0;  ///< of its first row
  int width_px = 0;
  int height_px = 0;

  friend bool operator==(const ImageRegion&, const ImageRegion&) = default;
};

}  // namespace vantage
