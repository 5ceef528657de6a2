#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/image/image.h"

namespace vantage {

/// Paints `wanted` pixels (255, else 0) of an image anew from the background around them, with
/// OpenCV's fast marching method (A. Telea, 2004) over a radius of 5 pixels. `disparity_px`, of the
/// image's size: where wanted, of the background there, NaN if that is unknown. What is nearer by
/// more than the limit, around runs of up to 64 pixels in a row, is not looked at, so that no
/// foreground is smeared into the background. Other pixels stay as they are; values remain within
/// the pixel type's range, for floats the image's where that is wider. An image without any other
/// pixel is left alone. T is uint8_t, uint16_t or float.
///
/// Thread rule: as for a plain function that writes the image; works on one thread and allocates.
template <typename T>
void inpaint_background(ImageView<T> image, ImageView<const std::uint8_t> wanted,
                        ImageView<const float> disparity_px, double gradient_limit_px);

/// Memory that it works in for an image of this shape.
std::size_t inpainting_bytes(int width, int height, int channels);

}  // namespace vantage
