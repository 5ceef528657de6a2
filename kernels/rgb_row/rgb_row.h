#pragma once

#include <cstdint>

namespace vantage::kernels {

/// RGB from 16-bit luma and chroma; see rgb_row().
struct ColourFactors {
  float black = 0;  ///< luma of it
  float grey = 1;   ///< per luma
  float red_of_red = 0;
  float green_of_red = 0;
  float green_of_blue = 0;
  float blue_of_blue = 0;
};

/// A row of pixels with chroma of their own, which is 128 · 256 where there is no colour.
struct LumaChromaRow {
  const std::uint16_t* luma = nullptr;
  const std::uint16_t* chroma_blue = nullptr;
  const std::uint16_t* chroma_red = nullptr;
  int width = 0;  ///< ≥ 0
};

/// rgb[3x], [3x + 1], [3x + 2] = red, green and blue of pixel x: g + red_of_red · r,
/// g − green_of_red · r − green_of_blue · b and g + blue_of_blue · b with g = (luma − black) · grey
/// and chroma r and b from its neutral value; limited to the range of the type, then rounded.
/// `rgb` has 3 · width values and does not overlap the row. Identical on every instruction set and
/// to the reference.
void rgb_row(const LumaChromaRow& row, const ColourFactors& factors, std::uint8_t* rgb);
void rgb_row(const LumaChromaRow& row, const ColourFactors& factors, std::uint16_t* rgb);

void rgb_row_ref(const LumaChromaRow& row, const ColourFactors& factors, std::uint8_t* rgb);
void rgb_row_ref(const LumaChromaRow& row, const ColourFactors& factors, std::uint16_t* rgb);

}  // namespace vantage::kernels
