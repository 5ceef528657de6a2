#include "kernels/combined_cost/fixed_planes.h"

#include <algorithm>

#include "kernels/combined_cost/combined_cost.h"

namespace vantage::kernels {
namespace {

std::uint16_t fixed(float value, int offset, int max) {
  const float scaled = (value + static_cast<float>(offset)) * kFixedPerIntensity + 0.5F;
  return static_cast<std::uint16_t>(std::clamp(scaled, 0.0F, static_cast<float>(max)));
}

std::uint16_t fixed_intensity(float level) {
  return fixed(level, kFixedIntensityOffset, kMaxFixed);
}

std::uint16_t fixed_gradient(float gradient) {
  return fixed(gradient, kFixedGradientOffset, kMaxFixedGradient);
}

}  // namespace

void fixed_intensities_row(const float* grey, int width, const FixedIntensityRow& fixed) {
  for (int x = 0; x < width; ++x) {
    const float before = 0.5F * (grey[x] + grey[x - 1]);
    const float after = 0.5F * (grey[x] + grey[x + 1]);
    fixed.level[x] = fixed_intensity(grey[x]);
    fixed.min[x] = fixed_intensity(std::min({before, after, grey[x]}));
    fixed.max[x] = fixed_intensity(std::max({before, after, grey[x]}));
  }
}

void fixed_gradient_row(const float* above, const float* row, const float* below, int width,
                        std::uint16_t* gx, std::uint16_t* gy) {
  for (int x = 0; x < width; ++x) {
    gx[x] = fixed_gradient(0.5F * (row[x + 1] - row[x - 1]));
    gy[x] = fixed_gradient(0.5F * (below[x] - above[x]));
  }
}

}  // namespace vantage::kernels
