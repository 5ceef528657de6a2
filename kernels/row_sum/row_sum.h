#pragma once

#include <cstdint>

namespace vantage::kernels {

/// One row of sliding sums along x over cells of `lanes` disparities. Columns are numbered as in
/// the image; columns outside [input_begin, input_end) are absent.
struct RowSum {
  const std::int32_t* input = nullptr;  ///< first cell of input_begin
  int input_begin = 0;                  ///< ≤ max(0, output_begin − radius)
  int input_end = 0;                    ///< ≥ min(image width, output_end + radius)
  int output_begin = 0;
  int output_end = 0;
  int radius = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
  /// Adds the lane number to every lane of the output. The low bits of a cell then identify its
  /// candidate, if inputs are multiples of a power of two that leaves room for it.
  bool number_lanes = false;

  /// If not null: window sums of the last output column, `lanes` values, for a call that continues
  /// at the next column. Read if `continues`; always written.
  std::int32_t* window_sums = nullptr;
  bool continues = false;  ///< the previous call ended at output_begin

  std::int32_t* output =
      nullptr;  ///< first cell of output_begin; null if only minima are requested
  /// If not null: one value per output column, the minimum of its cells [0, candidates).
  std::int32_t* minima = nullptr;
  int candidates = 0;                   ///< 1..lanes; for minima only
  std::int32_t* minima_work = nullptr;  ///< kLaneMultiple values per output column, for minima only
};

/// output(x, i) = Σ input(x − radius … x + radius, i) [+ i]. Running sums: the work per cell does
/// not depend on the radius. Exact modulo 2³². Identical on every instruction set.
void row_sum(const RowSum& row);

}  // namespace vantage::kernels
