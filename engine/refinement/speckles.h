#pragma once

#include <cstdint>
#include <vector>

#include "engine/image/image.h"

namespace vantage {

/// Working memory of mark_speckles(), reused from call to call.
struct SpeckleWork {
  std::vector<std::uint8_t> visited;
  std::vector<std::int32_t> region;
};

/// Marks as unmatched (255) the matched pixels (0 in `unmatched`) of regions smaller than
/// `least_pixels`. A region is connected over its 4-neighbours whose disparities differ by at most
/// 1 px, one surface in the sense of the gradient limit (EQUATIONS §6). Wrong matches that the
/// cross-check lets through are small islands; constant-depth fill would draw them out into
/// streaks. map_px and unmatched have the same size; pixels with unmatched = 0 are finite. Of a
/// two-dimensional search map_y_px holds the second component, in which neighbours must agree as
/// well; else it is empty.
void mark_speckles(ImageView<const float> map_px, ImageView<const float> map_y_px, int least_pixels,
                   SpeckleWork& work, Mask& unmatched);

}  // namespace vantage
