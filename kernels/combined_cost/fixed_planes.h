#pragma once

#include <cstdint>

namespace vantage::kernels {

// 16-bit planes that the combined cost reads (format: combined_cost.h), computed from rows of grey
// levels with a margin of at least one column on both sides. Identical on every instruction set.

/// One row of grey levels in 16 bits.
struct FixedIntensityRow {
  std::uint16_t* level = nullptr;
  std::uint16_t* min = nullptr;  ///< minimum within half a pixel, linearly interpolated
  std::uint16_t* max = nullptr;
};
void fixed_intensities_row(const float* grey, int width, const FixedIntensityRow& fixed);

/// Central differences of `row`, in grey levels per pixel.
void fixed_gradient_row(const float* above, const float* row, const float* below, int width,
                        std::uint16_t* gx, std::uint16_t* gy);

}  // namespace vantage::kernels
