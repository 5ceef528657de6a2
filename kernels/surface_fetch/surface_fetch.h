#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// Colours of one row of a new view, fetched from anywhere in the source image (3.2.7).
template <typename T>
struct SurfaceFetchRow {
  const T* pixels = nullptr;      ///< the image's pixel (0, 0); interleaved channels
  std::ptrdiff_t stride = 0;      ///< values from one of its rows to the next
  const float* map_px = nullptr;  ///< its disparities, likewise
  std::ptrdiff_t map_stride = 0;
  int width = 0;     ///< ≥ 1
  int height = 0;    ///< ≥ 1
  int channels = 0;  ///< 1, 3 or 4
  /// Where each new pixel lies, as source_positions_row() makes it.
  const std::int32_t* column = nullptr;  ///< −1..width − 1
  const std::int32_t* line = nullptr;    ///< −1..height − 1
  const float* fraction_x = nullptr;
  const float* fraction_y = nullptr;
  const float* disparity_px = nullptr;  ///< of the surface it shows; NaN = hole
  int count = 0;                        ///< new pixels, ≥ 0
  float gradient_limit_px = 1;  ///< taps whose disparity differs by more show another surface
};

/// One bicubic interpolation in both directions (Keys, a = −½), where colours do not mix across
/// depth discontinuities. A tap outside the image or on another surface has the value of its
/// neighbour towards the centre: in each of the four rows of taps by the rule of
/// fetch_bicubic_row(), then from row to row by the same rule, where a row counts as on the surface
/// if one of its two inner taps is. Where none of the inner four is, all have the value of the
/// nearest pixel.
///
/// Writes pixel_lanes(channels) values per pixel (pixel_row.h), in 0..kLargestValue<T>, for floats
/// the range of the taps where that is wider. Holes become 0. Where y is whole, it is what
/// fetch_bicubic_row() gives, for floats outside 0..1 up to that range.
/// Identical on every instruction set and to the reference.
void fetch_surface_row(const SurfaceFetchRow<std::uint8_t>& row, float* colours);
void fetch_surface_row(const SurfaceFetchRow<std::uint16_t>& row, float* colours);
void fetch_surface_row(const SurfaceFetchRow<float>& row, float* colours);

void fetch_surface_row_ref(const SurfaceFetchRow<std::uint8_t>& row, float* colours);
void fetch_surface_row_ref(const SurfaceFetchRow<std::uint16_t>& row, float* colours);
void fetch_surface_row_ref(const SurfaceFetchRow<float>& row, float* colours);

}  // namespace vantage::kernels
