#pragma once

#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// The picture with rows and columns exchanged. Thread rule: pure.
Photograph transposed(const Photograph& photograph);
DisparityMap transposed(ImageView<const float> map);
Mask transposed(ImageView<const std::uint8_t> mask);

}  // namespace vantage
