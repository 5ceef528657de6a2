#include <algorithm>
#include <cmath>

#include "kernels/known_range/known_range.h"

namespace vantage::kernels {

KnownRange known_range_row_ref(const float* disparity_px, int count, KnownRange range) {
  for (int i = 0; i < count; ++i) {
    if (std::isfinite(disparity_px[i])) {
      range.min = std::min(range.min, disparity_px[i]);
      range.max = std::max(range.max, disparity_px[i]);
    }
  }
  return range;
}

}  // namespace vantage::kernels
