#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/image/image.h"

namespace vantage {

/// Inpaints the `wanted` pixels (255, else 0) of an image from the background around them, with
/// OpenCV's fast marching method (A. Telea, 2004) and a radius of 5 pixels. `disparity_px`, of the
/// image's size: at wanted pixels, of the background there, NaN if unknown. Pixels nearer than that
/// by more than the limit are excluded around runs of up to 64 pixels in a row, so that no
/// foreground is smeared into the background. Other pixels are unchanged; values remain within the
/// pixel type's range, for floats the image's if that is wider. An image without other pixels is
/// unchanged. T is uint8_t, uint16_t or float.
///
/// Thread rule: as for a plain function that writes the image; runs on one thread and allocates.
template <typename T>
void inpaint_background(ImageView<T> image, ImageView<const std::uint8_t> wanted,
                        ImageView<const float> disparity_px, double gradient_limit_px);

/// Working memory for an image of this shape, in bytes.
std::size_t inpainting_bytes(int width, int height, int channels);

}  // namespace vantage
