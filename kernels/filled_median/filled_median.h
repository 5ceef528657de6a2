#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// One row of a filled disparity map and its surroundings.
struct FilledRow {
  const float* disparity_px = nullptr;      ///< NaN = unknown, which does not count
  std::ptrdiff_t disparity_pitch = 0;       ///< values from row to row
  const std::uint8_t* pixels = nullptr;     ///< the map's own image: [x · channels + c], 0..255
  std::ptrdiff_t pixel_pitch = 0;           ///< values from row to row
  int channels = 1;                         ///< 1, 3 or 4; alpha is not looked at
  const std::uint8_t* unmatched = nullptr;  ///< of this row; ≠ 0: filled, not matched
  int width = 0;
  int rows_above = 0;  ///< that the map has; ≥ 0
  int rows_below = 0;
};

/// The samples of a filled pixel are kFilledMedianSamples² places, kFilledMedianStepPx apart in
/// both directions, itself in the middle.
constexpr int kFilledMedianSamples = 7;
constexpr int kFilledMedianStepPx = 3;
/// A sample counts exp(−s/this), s = sum of the absolute differences of the three channels (of grey
/// pixels three times the one), in steps of 1/4096.
constexpr double kFilledMedianLevels = 25;

/// filled_px[x] of unmatched pixels becomes the weighted median of the disparities around it: of
/// the samples inside the map those that look like the pixel count more. The median is the least
/// sample such that it and those below have at least half of all weight; where no sample is known,
/// the pixel keeps its value. `filled_px` comes with the values of `row`, which stay as they are,
/// so that rows are independent of each other. Sums of integers: identical on every machine. One
/// plain version: unmatched pixels are few, and selecting is all branches.
void take_filled_medians_row(const FilledRow& row, float* filled_px);

}  // namespace vantage::kernels
