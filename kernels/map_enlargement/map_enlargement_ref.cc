#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "kernels/map_enlargement/map_enlargement.h"

namespace vantage::kernels {

void enlarge_map_row_ref(const EnlargedRow& row, int begin, int end, float* disparity_px) {
  const int last = (row.width - 1) / 2;
  for (int x = begin; x < end; ++x) {
    const int own = x / 2;
    const int beside = std::clamp(x % 2 == 0 ? own - 1 : own + 1, 0, last);
    const float value = row.own_px[own];
    const auto difference = [&](std::uint8_t intensity) {
      return std::abs(row.intensities[x] - intensity);
    };
    const auto quarter = [&](float other) {
      const float step = other - value;
      return std::fabs(step) <= kEnlargedSurfaceStepPx ? step * 0.25F : 0.0F;
    };
    float result = value + (quarter(row.own_px[beside]) + quarter(row.beside_px[own]));
    int nearest = difference(row.own_intensities[own]) - kEnlargedPreference;
    const auto consider = [&](float other, std::uint8_t intensity) {
      if (std::fabs(other - value) > kEnlargedSurfaceStepPx && difference(intensity) < nearest) {
        nearest = difference(intensity);
        result = other;
      }
    };
    consider(row.own_px[beside], row.own_intensities[beside]);
    consider(row.beside_px[own], row.beside_intensities[own]);
    consider(row.beside_px[beside], row.beside_intensities[beside]);
    disparity_px[x] = result;
  }
}

}  // namespace vantage::kernels
