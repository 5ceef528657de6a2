#include <algorithm>

#include "kernels/row_sum/row_sum.h"

namespace vantage::kernels {

void row_sum_ref(const RowSum& row) {
  for (int x = row.output_begin; x < row.output_end; ++x) {
    const int first = std::max(x - row.radius, row.input_begin);
    const int last = std::min(x + row.radius, row.input_end - 1);
    const int j = x - row.output_begin;
    for (int i = 0; i < row.lanes; ++i) {
      std::uint32_t modulo_sum = row.number_lanes ? static_cast<std::uint32_t>(i) : 0;
      for (int column = first; column <= last; ++column) {
        modulo_sum +=
            static_cast<std::uint32_t>(row.input[(column - row.input_begin) * row.lanes + i]);
      }
      const auto sum = static_cast<std::int32_t>(modulo_sum);
      if (row.output != nullptr) {
        row.output[j * row.lanes + i] = sum;
      }
      if (row.window_sums != nullptr) {
        row.window_sums[i] = sum;  // the last column's value remains
      }
      if (row.minima != nullptr && i < row.candidates) {
        row.minima[j] = i == 0 ? sum : std::min(row.minima[j], sum);
      }
    }
  }
}

}  // namespace vantage::kernels
