#pragma once

#include <cstdint>

namespace vantage::kernels {

/// levels[x] = the grey level of an 8-bit pixel, x in [0, width): the value itself of one channel;
/// of three or four the luma (77 R + 150 G + 29 B) / 256, rounded, alpha left out. For comparing
/// frames with each other. channels is 1, 3 or 4. Equal to
/// the reference on every instruction set.
void luma_levels_row(const std::uint8_t* pixels, int width, int channels, std::uint8_t* levels);
void luma_levels_row_ref(const std::uint8_t* pixels, int width, int channels, std::uint8_t* levels);

/// Weights of the luma (Rec. 601).
inline constexpr float kLumaRed = 0.299F;
inline constexpr float kLumaGreen = 0.587F;
inline constexpr float kLumaBlue = 0.114F;

/// luma[x] = the luma of an 8-bit pixel, 0..255, not rounded, x in [0, width): what matching takes.
/// channels is 3 or 4, alpha left out. Equal to the reference on every instruction set.
void luma_row(const std::uint8_t* pixels, int width, int channels, float* luma);
void luma_row_ref(const std::uint8_t* pixels, int width, int channels, float* luma);

}  // namespace vantage::kernels
