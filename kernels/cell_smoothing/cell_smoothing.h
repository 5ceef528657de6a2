#pragma once

#include <array>

namespace vantage::kernels {

// Convolution of rows of float cells (`lanes` per column) with symmetric kernels of odd length.
// Cells outside the image are 0. The operations per cell and their order depend neither on the
// division into strips nor on the instruction set.

/// Weighted sum of 2·radius + 1 runs of cells; the two runs at distance k ≥ 1 from the middle share
/// a weight:
///   output[i] = weights[0] · middle[i] + weights[1] · (before[i] + after[i]) + …,
/// added in this order. The runs are cells of neighbouring rows, or of one row shifted by columns.
struct SymmetricSum {
  /// First to last run. Null: outside the image, adds nothing. The middle run is never null.
  const float* const* runs = nullptr;
  const float* weights = nullptr;  ///< radius + 1
  int radius = 0;
  int count = 0;  ///< cells per run, a multiple of kLaneMultiple
};
void symmetric_sum(const SymmetricSum& sum, float* output);

/// Wells' cascade of box filters of widths 3, 3, 3 and 5 (variance 4) in y and x in one pass: the
/// composite kernel over the rows, then box after box along the row, in registers. Normalised.
struct BoxCascade {
  static constexpr std::array<int, 4> kWidths = {3, 3, 3, 5};
  static constexpr int kRadius = 5;
  /// Composite kernel from the middle outwards, in units of the product of the widths.
  static constexpr std::array<float, kRadius + 1> kWeights = {25, 23, 17, 10, 4, 1};
  static constexpr float kUnitGain = 1.0F / (135 * 135);

  /// First cell of column input_begin in rows y − kRadius … y + kRadius; null outside the image.
  const float* const* rows = nullptr;
  // Image column numbers; columns outside [input_begin, input_end) count as outside the image.
  int input_begin = 0;  ///< ≤ max(0, output_begin − kRadius)
  int input_end = 0;    ///< ≥ min(image width, output_end + kRadius)
  int output_begin = 0;
  int output_end = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
};
/// Computes one row. `work`: room for the cells of the input columns; `output`: first cell of
/// output_begin.
void box_cascade_row(const BoxCascade& cascade, float* work, float* output);

}  // namespace vantage::kernels
