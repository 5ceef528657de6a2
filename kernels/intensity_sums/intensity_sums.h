#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Two warped scanlines: colours [x · lanes + c] and disparities, NaN = hole.
struct WarpedPairRow {
  const float* left_colours = nullptr;
  const float* right_colours = nullptr;
  const float* left_disparity_px = nullptr;
  const float* right_disparity_px = nullptr;
  int width = 0;
  int lanes = 0;                ///< 1 or 4: pixel_lanes(channels)
  float gradient_limit_px = 1;  ///< disparities that differ by at most this are on the same surface
};

/// The sums of (3.11), per channel.
struct IntensitySums {
  std::int64_t pixels = 0;
  double left[4] = {};
  double right[4] = {};
  double left_right[4] = {};
  double left_left[4] = {};

  /// Adds the sums of other rows. Callers fix the order, so that rounding is reproducible.
  void add(const IntensitySums& other);
};

/// Sums over the positions of one scanline where both images show the same surface, from left to
/// right. Identical on every instruction set and to the reference.
IntensitySums intensity_sums_row(const WarpedPairRow& row);
IntensitySums intensity_sums_row_ref(const WarpedPairRow& row);

}  // namespace vantage::kernels
