#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Working memory of take_filled_medians(), reused from call to call.
struct FilledMediansWork {
  DisparityMap before;         ///< the map, with margins
  Image<std::uint8_t> pixels;  ///< of the photograph as the kernel takes them, with margins
};

inline std::size_t held_bytes(const FilledMediansWork& work) {
  return held_bytes(work.before) + held_bytes(work.pixels);
}

/// Gives filled pixels (≠ 0 in `unmatched`) the weighted median of the disparities around them,
/// those of pixels that look alike counting more (kernels/filled_median). Filling at constant depth
/// decides for each row alone; this lets rows vote and follows the image's outlines. `photograph`
/// is the map's own; all have one size. Identical for any `execution`.
void take_filled_medians(const Mask& unmatched, const Photograph& photograph, Execution& execution,
                         FilledMediansWork& work, DisparityMap& map_px);

}  // namespace vantage
