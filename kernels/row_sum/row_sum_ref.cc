#include <algorithm>

#include "kernels/row_sum/row_sum.h"

namespace vantage::kernels {

void row_sum_ref(const RowSum& row) {
  for (int x = row.output_begin; x < row.output_end; ++x) {
    const int first = std::max(x - row.radius, row.input_begin);
    const int last = std::min(x + row.radius, row.input_end - 1);
    for (int i = 0; i < row.lanes; ++i) {
      std::int32_t sum = row.number_lanes ? i : 0;
      for (int column = first; column <= last; ++column) {
        sum += row.input[(column - row.input_begin) * row.lanes + i];
      }
      row.output[(x - row.output_begin) * row.lanes + i] = sum;
    }
  }
}

}  // namespace vantage::kernels
