#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// A pixel of another image: line in the upper 16 bits, column in the lower 16 bits.
using PixelPlace = std::uint32_t;
/// No pixel; outside every supported image size.
inline constexpr PixelPlace kNoPlace = 0xFFFFFFFF;

[[nodiscard]] constexpr PixelPlace pixel_place(int column, int line) {
  return static_cast<PixelPlace>(line) << 16U | static_cast<PixelPlace>(column);
}

/// result[i] = value of `map` at places[i], NaN for kNoPlace. `map` points to pixel (0, 0); rows
/// are `stride` values apart. Scalar code only: vector gathers take as long.
void look_up_row(const float* map, std::ptrdiff_t stride, const PixelPlace* places, int count,
                 float* result);

}  // namespace vantage::kernels
