#pragma once

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Columns of an image shifted against each other, so that lines which rise by `slope` become rows:
/// sheared pixel (x, y) shows position (x, y + slope · x − offset). Two images whose cameras stand
/// obliquely in a plane, look the same way and have square pixels correspond along such lines; both
/// sheared alike are a rectified pair, whose disparities are the component along x. A shear
/// interpolates along columns only, and keeps columns apart as they are, where a rotation would
/// interpolate in both directions.
///
/// Thread rule: pure; parallel over rows, identical for any execution and instruction set.
struct Shear {
  double slope = 0;  ///< within ±1
  int offset = 0;    ///< rows that position (0, 0) moves down

  /// For images of this width.
  Shear(double slope_of_lines, int width_px);
  /// Of a sheared image, so that nothing is cut off.
  [[nodiscard]] int height(int height_px, int width_px) const;
};

/// `photograph` sheared, by bicubic interpolation; beyond its upper and lower border it is
/// continued by the border's own pixels.
Photograph sheared(const Photograph& photograph, const Shear& shear, Execution& execution);

/// A map of a sheared image on the grid of that image itself, which has `height_px` rows. Between
/// two rows of the map that differ by at most a pixel it is interpolated, else the nearer row
/// decides.
DisparityMap unsheared_disparity(ImageView<const float> map, const Shear& shear, int height_px,
                                 Execution& execution);
/// The same for a mask, always of the nearest row.
Mask unsheared_mask(ImageView<const std::uint8_t> mask, const Shear& shear, int height_px);

/// Marks as unmatched, 255, where the partner lies beyond the upper or lower border of the other
/// image: what was found there was found in what continues it. `map` and `unmatched` are on the
/// grid of an image, disparities along x; `partner_direction` is −1 for the first image of a pair,
/// whose partners are at x − d, +1 for the second.
void mark_partners_beyond_border(ImageView<const float> map, const Shear& shear,
                                 int partner_direction, ImageView<std::uint8_t> unmatched);

}  // namespace vantage
