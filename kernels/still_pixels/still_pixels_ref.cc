#include <algorithm>
#include <cstdlib>

#include "kernels/still_pixels/still_pixels.h"

namespace vantage::kernels {

void box_change_row_ref(const FrameRows& rows, std::int16_t* /*work*/, std::int16_t* change) {
  const auto column = [&](int x) {
    x = std::clamp(x, 0, rows.width - 1);
    int sum = 0;
    for (int k = 0; k < 3; ++k) {
      sum += rows.now[k][x] - rows.before[k][x];
    }
    return sum;
  };
  for (int x = 0; x < rows.width; ++x) {
    change[x] = static_cast<std::int16_t>(std::abs(column(x - 1) + column(x) + column(x + 1)));
  }
  change[-1] = change[0];
  change[rows.width] = change[rows.width - 1];
}

void still_row_ref(const std::int16_t* const changes[3], int width, std::int16_t limit,
                   std::uint8_t* still) {
  for (int x = 0; x < width; ++x) {
    std::int16_t max = 0;
    for (int k = 0; k < 3; ++k) {
      max = std::max({max, changes[k][x - 1], changes[k][x], changes[k][x + 1]});
    }
    still[x] = max <= limit ? 255 : 0;
  }
}

}  // namespace vantage::kernels
