#pragma once

#include <cstdint>

namespace vantage::kernels {

/// Rows of pixels as the synthesis kernels want them: float values in the source's own units, each
/// pixel padded to whole vectors of a few lanes, so that one vector holds one pixel.
constexpr int pixel_lanes(int channels) { return channels == 1 ? 1 : 4; }

/// Pixels that may be read, whatever they hold, and disparities that are NaN, on either side of a
/// source row.
inline constexpr int kRowMarginPx = 2;

/// The largest value of a pixel type in a photograph; the smallest is 0.
template <typename T>
inline constexpr float kLargestValue = 1.0F;
template <>
inline constexpr float kLargestValue<std::uint8_t> = 255.0F;
template <>
inline constexpr float kLargestValue<std::uint16_t> = 65535.0F;

/// pixels[x · channels + c], x in [0, width), to row[x · pixel_lanes + c]; x = 0 is kRowMarginPx
/// pixels into the memory of `row`. Margins and spare lanes become 0. channels is 1, 3 or 4.
/// Identical on every instruction set and to the reference.
void load_pixel_row(const std::uint8_t* pixels, int width, int channels, float* row);
void load_pixel_row(const std::uint16_t* pixels, int width, int channels, float* row);
void load_pixel_row(const float* pixels, int width, int channels, float* row);

void load_pixel_row_ref(const std::uint8_t* pixels, int width, int channels, float* row);
void load_pixel_row_ref(const std::uint16_t* pixels, int width, int channels, float* row);
void load_pixel_row_ref(const float* pixels, int width, int channels, float* row);

}  // namespace vantage::kernels
