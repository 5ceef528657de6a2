#pragma once

#include "engine/image/image.h"

namespace vantage {

/// The disparity at a position within a map, in pixels from the centre of its first one: bilinear
/// among four pixels that differ by at most 1 px, else that of the nearest. NaN = unknown. Thread
/// rule: pure.
float interpolated_disparity(ImageView<const float> map, double x, double y);

}  // namespace vantage
