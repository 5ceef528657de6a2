#pragma once

#include <cstdint>

namespace vantage::kernels {

/// levels[x] = grey level of an 8-bit pixel, x in [0, width). One channel: the value itself. Three
/// or four: the luma (77 R + 150 G + 29 B) / 256, rounded; alpha is ignored. For comparing frames.
/// channels is 1, 3 or 4. Equal to the reference on every instruction set.
void luma_intensity_row(const std::uint8_t* pixels, int width, int channels,
                        std::uint8_t* intensities);
void luma_intensity_row_ref(const std::uint8_t* pixels, int width, int channels,
                            std::uint8_t* intensities);

/// Luma weights (Rec. 601).
inline constexpr float kLumaRed = 0.299F;
inline constexpr float kLumaGreen = 0.587F;
inline constexpr float kLumaBlue = 0.114F;

/// luma[x] = luma of an 8-bit pixel, 0..255, not rounded, x in [0, width): the input of matching.
/// channels is 3 or 4; alpha is ignored. Equal to the reference on every instruction set.
void luma_row(const std::uint8_t* pixels, int width, int channels, float* luma);
void luma_row_ref(const std::uint8_t* pixels, int width, int channels, float* luma);

}  // namespace vantage::kernels
