#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// A row of a new image, each pixel of which lies somewhere in another one.
template <typename T>
struct RemapRow {
  const T* pixels = nullptr;    ///< the other image's pixel (0, 0); interleaved channels
  std::ptrdiff_t stride = 0;    ///< values from one of its rows to the next
  int width = 0;                ///< 1..65500
  int height = 0;               ///< 1..65500
  int channels = 0;             ///< 1, 3 or 4
  const float* x_px = nullptr;  ///< position of each new pixel in the other image, centres at
  const float* y_px = nullptr;  ///< integers; any value
  int count = 0;                ///< new pixels, ≥ 0
};

/// Bicubic interpolation in both directions (Keys, a = −½); taps outside the image have the value
/// of the nearest pixel inside. Positions more than half a pixel outside, or NaN, give 0 in all
/// channels. Integers are rounded to the nearest and stay in their range; floats stay in 0..1, or
/// the range of the taps where that is wider. `result` has count · channels values and does not
/// overlap the image. Identical on every instruction set and to the reference.
void remap_bicubic_row(const RemapRow<std::uint8_t>& row, std::uint8_t* result);
void remap_bicubic_row(const RemapRow<std::uint16_t>& row, std::uint16_t* result);
void remap_bicubic_row(const RemapRow<float>& row, float* result);

void remap_bicubic_row_ref(const RemapRow<std::uint8_t>& row, std::uint8_t* result);
void remap_bicubic_row_ref(const RemapRow<std::uint16_t>& row, std::uint16_t* result);
void remap_bicubic_row_ref(const RemapRow<float>& row, float* result);

}  // namespace vantage::kernels
