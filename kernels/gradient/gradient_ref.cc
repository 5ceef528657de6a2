#include <cstddef>

#include "kernels/gradient/gradient.h"

namespace vantage::kernels {

void separable_filter_row_ref(const SeparableFilter& filter, float* work, float* filtered) {
  for (int k = 0; k < filter.width + 2 * kFilterRadius; ++k) {
    float sum = 0;
    for (std::size_t i = 0; i < filter.down.size(); ++i) {
      sum += filter.down[i] * filter.rows[i][k - kFilterRadius];
    }
    work[k] = sum;
  }
  for (int x = 0; x < filter.width; ++x) {
    float sum = 0;
    for (std::size_t i = 0; i < filter.along.size(); ++i) {
      sum += filter.along[i] * work[x + static_cast<int>(i)];
    }
    filtered[x] = sum;
  }
}

}  // namespace vantage::kernels
