#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "engine/image/photograph.h"
#include "engine/image/tile_mask.h"
#include "kernels/filled_median/filled_median.h"

namespace vantage {

/// Working memory of take_filled_medians(), reused from call to call.
struct FilledMediansWork {
  DisparityMap before;         ///< copy of the map, with margins
  Image<std::uint8_t> pixels;  ///< the photograph in the kernel's format, with margins

  /// Three channels of the photograph, 0..255.
  [[nodiscard]] const std::uint8_t* pixel(int x, int y) const {
    return pixels.row(y + kernels::kFilledMedianReachPx) +
           std::ptrdiff_t{kernels::kFilledPixelBytes} * (x + kernels::kFilledMedianMarginPx);
  }
};

inline std::size_t held_bytes(const FilledMediansWork& work) {
  return held_bytes(work.before) + held_bytes(work.pixels);
}

/// Brings a photograph into the format of the medians, for the calls below and pixel().
void frame_photograph(const Photograph& photograph, Execution& execution, FilledMediansWork& work);

/// Replaces filled pixels (≠ 0 in `unmatched`) by the weighted median of the disparities around
/// them; pixels of similar colour weigh more (kernels/filled_median). Constant-depth filling
/// decides for each row alone; the median combines rows and follows the image's outlines.
/// work: after frame_photograph() of the map's own photograph; all have one size. grid: at most the
/// default one. tiles: the only ones to change; null: all. Identical for any `execution`.
void take_filled_medians(const Mask& unmatched, const kernels::FilledMedianGrid& grid,
                         Execution& execution, FilledMediansWork& work, DisparityMap& map_px,
                         const TileMask* tiles = nullptr);

}  // namespace vantage
