#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Pixels of three channels in the opposite order, BGR as RGB: turned[3x + c] = pixels[3x + 2 − c].
/// Both have 3 · `width` values (width ≥ 0) and must not overlap.
void opposite_colour_order_row(const std::uint8_t* pixels, int width, std::uint8_t* turned);
void opposite_colour_order_row(const std::uint16_t* pixels, int width, std::uint16_t* turned);
void opposite_colour_order_row(const float* pixels, int width, float* turned);

/// Scalar references.
void opposite_colour_order_row_ref(const std::uint8_t* pixels, int width, std::uint8_t* turned);
void opposite_colour_order_row_ref(const std::uint16_t* pixels, int width, std::uint16_t* turned);
void opposite_colour_order_row_ref(const float* pixels, int width, float* turned);

}  // namespace vantage::kernels
