#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// Pixel rows for the synthesis kernels: float values in the source's own units. Each pixel is
/// padded so that one vector holds one pixel.
constexpr int pixel_lanes(int channels) { return channels == 1 ? 1 : 4; }

/// Margin on each side of a source row: readable pixels of any value, and NaN disparities. Kernels
/// read whole vectors that begin at any pixel.
inline constexpr int kRowMarginPx = 32;

/// Maximum value of a pixel type in a photograph; the minimum is 0.
template <typename T>
inline constexpr float kLargestValue = 1.0F;
template <>
inline constexpr float kLargestValue<std::uint8_t> = 255.0F;
template <>
inline constexpr float kLargestValue<std::uint16_t> = 65535.0F;

/// Copies pixels[x · channels + c], x in [0, width), to planes[c · stride + x]. Margins become 0.
/// channels is 1, 3 or 4. Identical on every instruction set.
void load_pixel_planes(const std::uint8_t* pixels, int width, int channels, std::ptrdiff_t stride,
                       float* planes);
void load_pixel_planes(const std::uint16_t* pixels, int width, int channels, std::ptrdiff_t stride,
                       float* planes);
void load_pixel_planes(const float* pixels, int width, int channels, std::ptrdiff_t stride,
                       float* planes);

}  // namespace vantage::kernels
