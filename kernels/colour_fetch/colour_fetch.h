#pragma once

#include <cstddef>

namespace vantage::kernels {

/// Colours of one warped scanline, fetched backward from the source (3.2.7): position n of the new
/// view shows source column n + s·d.
///
/// `pixels` and `source_disparity_px` are rows with margins (pixel_row.h); `warped_disparity_px`
/// and the result rows have none.
struct BicubicFetchRow {
  const float* pixels = nullptr;               ///< load_pixel_planes()
  std::ptrdiff_t stride = 0;                   ///< floats between planes
  const float* source_disparity_px = nullptr;  ///< for the same columns
  const float* warped_disparity_px = nullptr;  ///< output of forward_warp_row(); NaN = hole
  int width = 0;
  int channels = 0;             ///< 1, 3 or 4
  double camera_offset = 0;     ///< s, as in forward_warp_row()
  float gradient_limit_px = 1;  ///< taps whose disparity differs by more are on another surface
  float largest_value = 255;    ///< maximum of the pixel type
  bool is_in_range = false;     ///< true: all pixels are known to lie in 0..largest_value
};

/// One bicubic interpolation (Keys, a = −½) along the row. A tap outside the image or on another
/// surface takes the value of its neighbour towards the centre, so colours do not mix across depth
/// discontinuities. Results are clamped to 0..largest_value, or to the range of the taps where that
/// is wider. Holes and unused lanes become 0. colours: [x · pixel_lanes(channels) + c]. Identical
/// on every instruction set.
void fetch_bicubic_row(const BicubicFetchRow& row, float* colours);

/// Colours of one warped scanline, moved as in the book: the source pixel itself, or, in sampling
/// gaps, linear interpolation between the two nearest ones.
struct ForwardFetchRow {
  const float* pixels = nullptr;         ///< load_pixel_planes()
  std::ptrdiff_t stride = 0;             ///< floats between planes
  const float* source_column = nullptr;  ///< output of forward_warp_row(); NaN = hole
  int width = 0;
  int channels = 0;  ///< 1, 3 or 4
};

/// Colours as of fetch_bicubic_row(). Scalar code only: it is little more than a copy.
void fetch_forward_row(const ForwardFetchRow& row, float* colours);

}  // namespace vantage::kernels
