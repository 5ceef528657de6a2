#pragma once

#include <array>

namespace vantage::kernels {

// Convolution of rows of float cells (`lanes` a column) with symmetric kernels of odd length.
// Cells outside the image are 0. The operations that make a cell, and their order, depend neither
// on where rows are cut nor on the instruction set.

/// Weighted sum of 2·radius + 1 runs of cells, the same weight for the two that are k ≥ 1 places
/// away from the middle one:
///   output[i] = weights[0] · middle[i] + weights[1] · (before[i] + after[i]) + …,
/// added in this order. The runs are cells of neighbouring rows, or of one row shifted by columns.
struct SymmetricSum {
  /// From the first to the last; null outside the image, which adds nothing. Never the middle one.
  const float* const* runs = nullptr;
  const float* weights = nullptr;  ///< radius + 1
  int radius = 0;
  int count = 0;  ///< cells of a run, a multiple of kLaneMultiple
};
void symmetric_sum(const SymmetricSum& sum, float* output);
void symmetric_sum_ref(const SymmetricSum& sum, float* output);

/// Wells' cascade of box filters of widths 3, 3, 3 and 5 (variance 4) in y and x at once: down the
/// rows with the composite kernel, along them box after box, in registers. Normalised.
struct BoxCascade {
  static constexpr std::array<int, 4> kWidths = {3, 3, 3, 5};
  static constexpr int kRadius = 5;
  /// Composite kernel, from the middle, in units of the product of the widths.
  static constexpr std::array<float, kRadius + 1> kWeights = {25, 23, 17, 10, 4, 1};
  static constexpr float kUnitGain = 1.0F / (135 * 135);

  /// First cells of column input_begin in rows y − kRadius … y + kRadius; null outside the image.
  const float* const* rows = nullptr;
  // Columns as in the image; those outside [input_begin, input_end) count as outside the image.
  int input_begin = 0;  ///< ≤ max(0, output_begin − kRadius)
  int input_end = 0;    ///< ≥ min(image width, output_end + kRadius)
  int output_begin = 0;
  int output_end = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
};
/// Makes one row. `work`: room for the cells of the input columns; `output`: first cell of
/// output_begin.
void box_cascade_row(const BoxCascade& cascade, float* work, float* output);
void box_cascade_row_ref(const BoxCascade& cascade, float* output);

}  // namespace vantage::kernels
