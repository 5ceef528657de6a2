#pragma once

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// A smaller picture of the same depth and channels: each pixel is the mean of the area that it
/// covers, rounded to whole values where they are whole. width, height: at least 1, at most those
/// of `image`. Identical for any `execution`.
template <typename T>
Photograph area_average(ImageView<const T> image, int width, int height, Execution& execution);

}  // namespace vantage
