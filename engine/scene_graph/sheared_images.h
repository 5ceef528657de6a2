#pragma once

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// Shear of an image along its columns that turns lines of slope `slope` into rows: sheared pixel
/// (x, y) shows position (x, y + slope · x − offset). Two images of obliquely displaced coplanar
/// cameras with equal orientation and square pixels correspond along such lines; both sheared alike
/// are a rectified pair, whose disparities are the component along x. A shear interpolates along
/// columns only and preserves columns, where a rotation would interpolate in both directions.
///
/// Thread rule: pure; parallel over rows, identical for any execution and instruction set.
struct Shear {
  double slope = 0;  ///< within ±1
  int offset = 0;    ///< rows that position (0, 0) moves down

  /// For images of this width.
  Shear(double slope_of_lines, int width_px);
  /// Height of a sheared image that shows everything.
  [[nodiscard]] int height(int height_px, int width_px) const;
};

/// `photograph` sheared, by bicubic interpolation; the upper and lower border rows are replicated.
Photograph sheared(const Photograph& photograph, const Shear& shear, Execution& execution);

/// Resamples a map of a sheared image to the grid of the original image, which has `height_px`
/// rows. Interpolates between two rows that differ by at most a pixel, else takes the nearer row.
DisparityMap unsheared_disparity(ImageView<const float> map, const Shear& shear, int height_px,
                                 Execution& execution);
/// As unsheared_disparity() for a mask, always from the nearest row.
Mask unsheared_mask(ImageView<const std::uint8_t> mask, const Shear& shear, int height_px);

/// Marks as unmatched, 255, pixels whose partner lies beyond the upper or lower border of the other
/// image, where they matched replicated rows. `map` and `unmatched` are on the grid of an image,
/// disparities along x; `partner_direction` is −1 for the first image of a pair, whose partners are
/// at x − d, +1 for the second.
void mark_partners_beyond_border(ImageView<const float> map, const Shear& shear,
                                 int partner_direction, ImageView<std::uint8_t> unmatched);

}  // namespace vantage
