#pragma once

#include <cstdint>

namespace vantage::kernels {

// What the combined cost looks up, 16-bit as combined_cost.h says, from rows of grey levels with at
// least one column of margin on both sides. Identical on every instruction set.

/// One row of grey levels in 16 bits.
struct FixedLevelRow {
  std::uint16_t* level = nullptr;
  std::uint16_t* least = nullptr;  ///< within half a pixel, linearly interpolated
  std::uint16_t* most = nullptr;
};
void fixed_levels_row(const float* grey, int width, const FixedLevelRow& fixed);

/// Central differences, grey levels per pixel, of the row between two others.
void fixed_gradient_row(const float* above, const float* row, const float* below, int width,
                        std::uint16_t* gx, std::uint16_t* gy);

}  // namespace vantage::kernels
