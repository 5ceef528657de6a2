#pragma once

#include "engine/image/image.h"

namespace vantage {

// Images of another size, at least 1x1 pixels; the corners of both are in the same places. They
// give the bits of cv::resize() on amd64, but for up to three columns at the right of grey floats
// at half the size. Thread rule: pure.

/// The mean of the area that a pixel covers, rounded to nearest; the result is not larger in any
/// direction. 1, 3 or 4 channels. T: uint8_t, uint16_t or float.
template <typename T>
Image<T> reduced_by_area(ImageView<const T> image, int width, int height);

/// The pixel at the upper left corner of the one that is wanted. T: uint8_t or float.
template <typename T>
Image<T> resized_to_nearest(ImageView<const T> image, int width, int height);

/// Linear between pixel centres, the border repeated. One channel.
Image<float> resized_linearly(ImageView<const float> image, int width, int height);

}  // namespace vantage
