#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/integer_disparity/integer_disparity.h"

namespace vantage::kernels {

int integer_disparity_row_ref(const float* disparity_px, int width, std::uint16_t* stored) {
  for (int x = 0; x < width; ++x) {
    if (!std::isfinite(disparity_px[x])) {
      stored[x] = 0;
      continue;
    }
    const double rounded = std::round(double{disparity_px[x]} * kIntegerUnitsPerPx);
    if (rounded < 0 || rounded > std::numeric_limits<std::uint16_t>::max()) {
      return x;
    }
    stored[x] = static_cast<std::uint16_t>(std::max(rounded, 1.0));
  }
  return width;
}

}  // namespace vantage::kernels
