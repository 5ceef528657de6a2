#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Disparities as 16-bit integers: round(256 · d), halves away from zero, and at least 1, because 0
/// stands for NaN and ±inf. Returns the first column whose disparity does not fit, −½ < 256 · d <
/// 65535.5; `width` if all do. What was written from that column on means nothing. Identical on
/// every instruction set and to the reference.
int integer_disparity_row(const float* disparity_px, int width, std::uint16_t* stored);
int integer_disparity_row_ref(const float* disparity_px, int width, std::uint16_t* stored);

/// Units per pixel of disparity.
inline constexpr float kIntegerUnitsPerPx = 256;

}  // namespace vantage::kernels
