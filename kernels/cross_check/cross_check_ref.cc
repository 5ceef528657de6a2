#include "kernels/cross_check/cross_check.h"

#include <cmath>

namespace vantage::kernels {

void cross_check_row_ref(const float* own_px, const float* other_px, int direction,
                         double tolerance_px, int width, std::uint8_t* unmatched) {
  for (int x = 0; x < width; ++x) {
    const double own = own_px[x];
    const double partner = std::floor(x + direction * own + 0.5);
    bool agrees = false;
    if (partner >= 0 && partner < width) {  // false for NaN
      // False when the other map is unknown there.
      agrees = std::abs(own - other_px[static_cast<int>(partner)]) < tolerance_px;
    }
    unmatched[x] = agrees ? 0 : 255;
  }
}

}  // namespace vantage::kernels
