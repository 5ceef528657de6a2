#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "kernels/flicker_sums/flicker_sums.h"

namespace vantage::kernels {

DisparityChange disparity_change_row_ref(const float* now_px, const float* before_px,
                                         const std::uint8_t* mask, int width) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kMax = 1024;
  constexpr float kUnitsPerPixel = 1024;
  DisparityChange sums{.min_px = kInfinity, .max_px = -kInfinity};
  for (int x = 0; x < width; ++x) {
    for (const float d : {now_px[x], before_px[x]}) {
      if (!std::isnan(d)) {
        sums.min_px = std::min(sums.min_px, d);
        sums.max_px = std::max(sums.max_px, d);
      }
    }
    const float change = std::abs(now_px[x] - before_px[x]);
    if (mask[x] != 0 && !std::isnan(change)) {
      ++sums.compared;
      sums.jumped += change > 1 ? 1 : 0;
      sums.change += static_cast<std::int64_t>(std::min(change, kMax) * kUnitsPerPixel + 0.5F);
    }
  }
  return sums;
}

IntensityChange intensity_change_row_ref(const std::uint8_t* now, const std::uint8_t* before,
                                         const std::uint8_t* mask, int width) {
  IntensityChange sums;
  for (int x = 0; x < width; ++x) {
    if (mask[x] != 0) {
      ++sums.compared;
      sums.change += std::abs(now[x] - before[x]);
    }
  }
  return sums;
}

std::int64_t intensity_sum_row_ref(const std::uint8_t* levels, int width) {
  std::int64_t sum = 0;
  for (int x = 0; x < width; ++x) {
    sum += levels[x];
  }
  return sum;
}

}  // namespace vantage::kernels
