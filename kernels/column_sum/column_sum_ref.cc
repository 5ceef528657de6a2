#include <cmath>

#include "kernels/column_sum/column_sum.h"

namespace vantage::kernels {

void column_sum_row_ref(const ColumnSum& row, const std::int32_t* previous, std::int32_t* sums) {
  const auto quantised = [&](const float* costs, int i) {
    return costs == nullptr
               ? 0U
               : static_cast<std::uint32_t>(std::lrint((costs[i] + row.offset) * row.scale));
  };
  for (int i = 0; i < row.count; ++i) {
    sums[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(previous[i]) +
                                        quantised(row.entering, i) - quantised(row.leaving, i));
  }
}

}  // namespace vantage::kernels
