#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage::kernels {

/// One row of a new image; each pixel has a position in another image.
template <typename T>
struct RemapRow {
  const T* pixels = nullptr;    ///< pixel (0, 0) of the other image; interleaved channels
  std::ptrdiff_t stride = 0;    ///< values between rows of the other image
  int width = 0;                ///< 1..65500
  int height = 0;               ///< 1..65500
  int channels = 0;             ///< 1, 3 or 4
  const float* x_px = nullptr;  ///< position of each new pixel in the other image, pixel centres at
                                ///< integers; any value
  const float* y_px = nullptr;  ///< integers; any value
  int count = 0;                ///< new pixels, ≥ 0
};

/// Bicubic interpolation in both directions (Keys, a = −½). Taps outside the image take the value
/// of the nearest pixel inside. Positions more than half a pixel outside, or NaN, give 0 in all
/// channels. Integers are rounded to nearest and clamped to their range; floats are clamped to
/// 0..1, or to the range of the taps where that is wider. `result` has count · channels values and
/// must not overlap the image. Identical on every instruction set.
void remap_bicubic_row(const RemapRow<std::uint8_t>& row, std::uint8_t* result);
void remap_bicubic_row(const RemapRow<std::uint16_t>& row, std::uint16_t* result);
void remap_bicubic_row(const RemapRow<float>& row, float* result);

}  // namespace vantage::kernels
