#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Conversion from 16-bit luma and chroma to RGB; see rgb_row().
struct ColourFactors {
  float black = 0;  ///< luma of black
  float grey = 1;   ///< factor of luma
  float red_of_red = 0;
  float green_of_red = 0;
  float green_of_blue = 0;
  float blue_of_blue = 0;
};

/// A row of pixels with one chroma pair per pixel; neutral chroma is 128 · 256.
struct LumaChromaRow {
  const std::uint16_t* luma = nullptr;
  const std::uint16_t* chroma_blue = nullptr;
  const std::uint16_t* chroma_red = nullptr;
  int width = 0;  ///< ≥ 0
};

/// rgb[3x], [3x + 1], [3x + 2] = red, green, blue of pixel x: g + red_of_red · r, g − green_of_red
/// · r − green_of_blue · b, g + blue_of_blue · b, with g = (luma − black) · grey and chroma r, b
/// relative to neutral; clamped to the range of the type, then rounded. `rgb` has 3 · width values
/// and must not overlap the row. Identical on every instruction set and to the reference.
void rgb_row(const LumaChromaRow& row, const ColourFactors& factors, std::uint8_t* rgb);
void rgb_row(const LumaChromaRow& row, const ColourFactors& factors, std::uint16_t* rgb);

void rgb_row_ref(const LumaChromaRow& row, const ColourFactors& factors, std::uint8_t* rgb);
void rgb_row_ref(const LumaChromaRow& row, const ColourFactors& factors, std::uint16_t* rgb);

}  // namespace vantage::kernels
