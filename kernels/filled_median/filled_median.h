#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// Largest FilledMedianGrid.
constexpr int kFilledMedianSamples = 7;
constexpr int kFilledMedianStepPx = 3;
constexpr int kFilledMedianReachPx = kFilledMedianSamples / 2 * kFilledMedianStepPx;
/// Columns read beyond the samples on both sides: a vector less one lane.
constexpr int kFilledRowSlack = 15;
constexpr int kFilledMedianMarginPx = kFilledMedianReachPx + kFilledRowSlack;
/// Three channels and a 0.
constexpr int kFilledPixelBytes = 4;

/// The samples of a filled pixel: count² positions on a grid centred on the pixel, step_px apart in
/// both directions.
struct FilledMedianGrid {
  int count = kFilledMedianSamples;  ///< odd
  int step_px = kFilledMedianStepPx;
};

/// One row of a filled disparity map and its neighbourhood.
struct FilledRow {
  /// Column 0 of the row; NaN = unknown, not used. Must be readable, and NaN beyond the map:
  /// kFilledMedianReachPx rows above and below, each kFilledMedianMarginPx columns wider than the
  /// map on both sides.
  const float* disparity_px = nullptr;
  std::ptrdiff_t disparity_pitch = 0;  ///< values between rows
  /// The map's own image, 0..255: [x · kFilledPixelBytes + c], grey as three equal channels.
  /// Readable like the disparities; arbitrary values beyond the map.
  const std::uint8_t* pixels = nullptr;
  std::ptrdiff_t pixel_pitch = 0;           ///< values between rows
  const std::uint8_t* unmatched = nullptr;  ///< for this row; ≠ 0: filled, not matched
  int width = 0;
  FilledMedianGrid grid = {};
};

/// Indexed by the sum of absolute differences of three channels.
using FilledMedianWeights = std::array<std::int32_t, std::size_t{3 * 255 + 1}>;
/// A sample's weight is exp(−s/this), where s is that sum, in steps of 1/kFilledUnitWeight.
constexpr double kFilledMedianLevels = 25;
constexpr int kFilledUnitWeight = 4096;
const FilledMedianWeights& filled_median_weights();

/// filled_px[x] of unmatched pixels becomes the weighted median of the disparities around it;
/// samples inside the map that look like the pixel weigh more. The median is the smallest sample
/// such that all samples up to it have at least half of the total weight; −0 counts as 0. A pixel
/// without known samples keeps its value. On entry `filled_px` must hold the values of `row`; `row`
/// is unchanged, so rows are independent of each other. Integer sums: identical on every
/// instruction set.
void take_filled_medians_row(const FilledRow& row, float* filled_px);

}  // namespace vantage::kernels
