#include "kernels/nearest_lookup/nearest_lookup.h"

#include <limits>

namespace vantage::kernels {

void look_up_row(const float* map, std::ptrdiff_t stride, const PixelPlace* places, int count,
                 float* result) {
  for (int i = 0; i < count; ++i) {
    const PixelPlace place = places[i];
    const auto column = static_cast<std::ptrdiff_t>(place & 0xFFFFU);
    const auto line = static_cast<std::ptrdiff_t>(place >> 16U);
    result[i] =
        place == kNoPlace ? std::numeric_limits<float>::quiet_NaN() : map[line * stride + column];
  }
}

}  // namespace vantage::kernels
