#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// Colours of one row of a new view, fetched from arbitrary positions in the source image (3.2.7).
template <typename T>
struct SurfaceFetchRow {
  const T* pixels = nullptr;      ///< pixel (0, 0) of the image; interleaved channels
  std::ptrdiff_t stride = 0;      ///< values between rows of the image
  const float* map_px = nullptr;  ///< the image's disparities, same layout
  std::ptrdiff_t map_stride = 0;
  int width = 0;     ///< ≥ 1
  int height = 0;    ///< ≥ 1
  int channels = 0;  ///< 1, 3 or 4
  /// Position of each new pixel, from source_positions_row().
  const std::int32_t* column = nullptr;  ///< −1..width − 1
  const std::int32_t* line = nullptr;    ///< −1..height − 1
  const float* fraction_x = nullptr;
  const float* fraction_y = nullptr;
  const float* disparity_px = nullptr;  ///< disparity of the surface shown; NaN = hole
  int count = 0;                        ///< new pixels, ≥ 0
  float gradient_limit_px = 1;  ///< taps whose disparity differs by more are on another surface
};

/// One bicubic interpolation in both directions (Keys, a = −½); colours do not mix across depth
/// discontinuities. A tap outside the image or on another surface takes the value of its neighbour
/// towards the centre: within each of the four rows of taps by the rule of fetch_bicubic_row(),
/// then between rows by the same rule, where a row is on the surface if one of its two inner taps
/// is. If none of the inner four is, all taps take the value of the nearest pixel.
///
/// Writes pixel_lanes(channels) values per pixel (pixel_row.h), in 0..kLargestValue<T>; for floats
/// in the range of the taps where that is wider. Holes become 0. Where y is an integer, the result
/// equals fetch_bicubic_row(), for floats outside 0..1 up to that range. Identical on every
/// instruction set.
void fetch_surface_row(const SurfaceFetchRow<std::uint8_t>& row, float* colours);
void fetch_surface_row(const SurfaceFetchRow<std::uint16_t>& row, float* colours);
void fetch_surface_row(const SurfaceFetchRow<float>& row, float* colours);

}  // namespace vantage::kernels
