#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Pixel rows for the synthesis kernels: float values in the source's own units. Each pixel is
/// padded so that one vector holds one pixel.
constexpr int pixel_lanes(int channels) { return channels == 1 ? 1 : 4; }

/// Margin on each side of a source row: readable pixels of any value, and NaN disparities.
inline constexpr int kRowMarginPx = 2;

/// Maximum value of a pixel type in a photograph; the minimum is 0.
template <typename T>
inline constexpr float kLargestValue = 1.0F;
template <>
inline constexpr float kLargestValue<std::uint8_t> = 255.0F;
template <>
inline constexpr float kLargestValue<std::uint16_t> = 65535.0F;

/// Copies pixels[x · channels + c], x in [0, width), to row[x · pixel_lanes + c]; x = 0 is
/// kRowMarginPx pixels after the start of `row`. Margins and unused lanes become 0. channels is 1,
/// 3 or 4. Identical on every instruction set.
void load_pixel_row(const std::uint8_t* pixels, int width, int channels, float* row);
void load_pixel_row(const std::uint16_t* pixels, int width, int channels, float* row);
void load_pixel_row(const float* pixels, int width, int channels, float* row);

}  // namespace vantage::kernels
