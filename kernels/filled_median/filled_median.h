#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// The samples of a filled pixel are kFilledMedianSamples² places, kFilledMedianStepPx apart in
/// both directions, itself in the middle.
constexpr int kFilledMedianSamples = 7;
constexpr int kFilledMedianStepPx = 3;
constexpr int kFilledMedianReachPx = kFilledMedianSamples / 2 * kFilledMedianStepPx;
/// Columns read beyond the samples: a vector less one.
constexpr int kFilledRowSlack = 15;
/// Three channels and a 0.
constexpr int kFilledPixelBytes = 4;

/// One row of a filled disparity map and its surroundings.
struct FilledRow {
  /// Column 0 of the row; NaN = unknown, which does not count. Readable and, beyond the map, NaN:
  /// kFilledMedianReachPx rows above and below, each from column −kFilledMedianReachPx to width − 1
  /// + kFilledMedianReachPx + kFilledRowSlack.
  const float* disparity_px = nullptr;
  std::ptrdiff_t disparity_pitch = 0;  ///< values from row to row
  /// The map's own image, 0..255: [x · kFilledPixelBytes + c], grey as three equal channels.
  /// Readable like the disparities, and beyond the map of any colour.
  const std::uint8_t* pixels = nullptr;
  std::ptrdiff_t pixel_pitch = 0;           ///< values from row to row
  const std::uint8_t* unmatched = nullptr;  ///< of this row; ≠ 0: filled, not matched
  int width = 0;
};

/// By the sum of the absolute differences of three channels.
using FilledMedianWeights = std::array<std::int32_t, std::size_t{3 * 255 + 1}>;
/// A sample counts exp(−s/this), s = that sum, in steps of 1/4096.
constexpr double kFilledMedianLevels = 25;
const FilledMedianWeights& filled_median_weights();

/// filled_px[x] of unmatched pixels becomes the weighted median of the disparities around it: of
/// the samples inside the map those that look like the pixel count more. The median is the least
/// sample such that it and those below have at least half of all weight, −0 being 0; where no
/// sample is known, the pixel keeps its value. `filled_px` comes with the values of `row`, which
/// stay as they are, so that rows are independent of each other. Sums of integers: identical on
/// every instruction set.
void take_filled_medians_row(const FilledRow& row, float* filled_px);

/// The same, plainly.
void take_filled_medians_row_ref(const FilledRow& row, float* filled_px);

}  // namespace vantage::kernels
