#pragma once

#include <cstddef>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/memory_use.h"
#include "engine/image/photograph.h"
#include "engine/image/side.h"

namespace vantage {

/// Working memory of find_uniform_pixels(), reused from call to call.
struct UniformPixelsWork {
  Image<float> grey;  ///< grey levels of the photograph
  Image<float> sums;  ///< of a window's row of intensity differences
  Mask flat;          ///< 255 where the window around the pixel has no texture
};

inline std::size_t held_bytes(const UniformPixelsWork& work) {
  return held_bytes(work.grey) + held_bytes(work.sums) + held_bytes(work.flat);
}

/// Marks the pixels without texture (255): in some window of 7×7 pixels that contains the pixel,
/// the mean of the 7×6 |I(x+1) − I(x)| of luma is at most `contrast` grey levels (EQUATIONS §5.9).
/// Resizes `textureless`. Identical for any `execution`.
void find_textureless_pixels(const Photograph& photograph, double contrast, Execution& execution,
                             UniformPixelsWork& work, Mask& textureless);

/// Clears the pixels of `uniform` that are matched, or hidden in the other image: at the smaller of
/// the disparities at the ends of its run of unmatched pixels, the pixel would lie outside the
/// other image, or where a matched pixel of the row, nearer than that, is. All have one size.
/// pixels_per_column: 1, or 2 for maps of half the size. Identical for any `execution`.
void keep_visible_unmatched(ImageView<const float> map_px, const Mask& unmatched, Side side,
                            int pixels_per_column, Execution& execution, Mask& uniform);

}  // namespace vantage
