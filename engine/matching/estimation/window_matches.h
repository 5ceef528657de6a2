#pragma once

#include <cstdint>
#include <vector>

#include "engine/execution.h"
#include "engine/image/disparity_range.h"
#include "engine/image/image.h"

namespace vantage {

/// Grey levels (0..255) of a small image, sampled twice per pixel of a row: fine texture has moved
/// by parts of its pixels.
struct HalfPixelImage {
  Image<float> at_pixels;
  Image<float> between;  ///< half a pixel to the right of each
};

/// Connected pixels of the left image whose matches differ by at most one pixel from neighbour to
/// neighbour.
struct MatchedRegion {
  std::vector<int> half_pixels;  ///< twice the disparity of each of its pixels, sorted
  /// Σ over its pixels of 1 − a/0.6, a = (1.02 − r₁)/(1.02 − r₂): r₁ the correlation at the match,
  /// r₂ the best one elsewhere. About 0.2 per pixel by chance, 0.7 on good texture.
  double support = 0;
  /// Where it lies: bit 8·row + column of a grid of 8 × 8 cells over the image.
  std::uint64_t cells = 0;
};

/// Matches of windows of 3 × 7 pixels that are evidence by themselves, without any assumption about
/// neighbours: they correlate by at least 0.75, so that contrast exceeds the noise, no other
/// disparity is nearly as good (as with bars of equal distance), and both images agree. For small
/// images, as of a range estimate.
///
/// Searches x_left − x_right in `columns` and y_left − y_right in `rows`, in steps of half a pixel
/// and one pixel. Compared are the deviations from local means. Images are of equal size. Regions
/// are ordered by their first pixel. Identical for any `execution` and on every instruction set.
/// Thread rule: may be called concurrently.
std::vector<MatchedRegion> find_window_matches(const HalfPixelImage& left,
                                               const HalfPixelImage& right, DisparityRange columns,
                                               DisparityRange rows, Execution& execution);

}  // namespace vantage
