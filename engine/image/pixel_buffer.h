#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/image/photograph.h"

namespace vantage {

/// Order of the channels of colours in memory. A fourth channel is alpha.
enum class ChannelOrder {
  kRgb,
  kBgr  ///< as OpenCV has them
};

/// Pixels in memory that someone else owns. Values are those of a Photograph: uint8_t 0..255,
/// uint16_t 0..65535, float 0..1.
template <typename T>
struct PixelBuffer {
  const T* data = nullptr;  ///< of the upper left pixel
  int width_px = 0;
  int height_px = 0;
  int channels = 1;  ///< 1, 3 or 4
  /// Distances in bytes, which may be negative; 0: values, pixels and rows follow each other.
  std::ptrdiff_t row_bytes = 0;
  std::ptrdiff_t pixel_bytes = 0;
  std::ptrdiff_t channel_bytes = 0;
  ChannelOrder order = ChannelOrder::kRgb;
};

/// Throws Error for a size or a number of channels that no photograph has, and where there are no
/// pixels. Reads none. Thread rule: pure.
template <typename T>
void check_pixel_buffer(const PixelBuffer<T>& buffer);

/// A photograph of the pixels of `buffer`. Where they lie in memory as an Image has them (values
/// and pixels follow each other, in RGB order, rows further on by a multiple of sizeof(T)) it reads
/// them in place: `buffer` must then outlive it and the photograph must not be written to.
/// Otherwise, and where floats are NaN, it is a copy; those pixels are left out (image/left_out.h).
/// Throws Error for a size or a number of channels that no photograph has, and for infinity. Thread
/// rule: pure.
template <typename T>
Photograph photograph_of(const PixelBuffer<T>& buffer);
/// As photograph_of(), but always a copy.
template <typename T>
Photograph copied_photograph(const PixelBuffer<T>& buffer);

}  // namespace vantage
