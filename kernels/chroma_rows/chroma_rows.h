#pragma once

#include <array>
#include <cstdint>

namespace vantage::kernels {

/// Conversion of R, G and B of 8 bits to luma and chroma of 8 bits. A factor f of the definition is
/// stored as f · 2¹⁵, rounded; a grey has no chroma where those of blue and of red add up to 0.
struct ChromaFactors {
  std::array<std::int32_t, 3> luma = {};         ///< of R, G and B
  std::array<std::int32_t, 3> chroma_blue = {};  ///< absolute values at most 2¹⁵
  std::array<std::int32_t, 3> chroma_red = {};
  std::int32_t black = 0;  ///< luma of black
};

/// Two rows of pixels R, G, B, and where their luma and chroma go.
struct ChromaRows {
  std::array<const std::uint8_t*, 2> rgb = {};
  std::array<std::uint8_t*, 2> luma = {};
  std::uint8_t* chroma_blue = nullptr;
  std::uint8_t* chroma_red = nullptr;
  int width = 0;  ///< even, ≥ 2
};

/// luma = black + the sum of factors · (R, G, B) of each pixel. Chroma of each second pixel = 128 +
/// the sum of factors · the mean of (R, G, B) over both rows and, by weights 1 : 2 : 1, three
/// columns; the first column is its own left neighbour. Exact in integers, then rounded, half up,
/// and clamped to 0..255. So chroma is sampled at the left, between the rows, as MPEG-2 and H.264
/// place it. Results must not overlap the rows.
void chroma_rows(const ChromaRows& rows, const ChromaFactors& factors);

}  // namespace vantage::kernels
