#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// A pixel of another image: its line in the upper, its column in the lower 16 bits.
using PixelPlace = std::uint32_t;
/// No pixel. Images are smaller than this.
inline constexpr PixelPlace kNoPlace = 0xFFFFFFFF;

[[nodiscard]] constexpr PixelPlace pixel_place(int column, int line) {
  return static_cast<PixelPlace>(line) << 16U | static_cast<PixelPlace>(column);
}

/// result[i] = the value of `map` at places[i], NaN at kNoPlace. `map`: its pixel (0, 0), rows
/// `stride` values apart. One plain version: loads that are gathered take as long in vectors.
void look_up_row(const float* map, std::ptrdiff_t stride, const PixelPlace* places, int count,
                 float* result);

}  // namespace vantage::kernels
