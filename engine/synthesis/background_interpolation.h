#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/execution.h"
#include "engine/image/image.h"

namespace vantage {

/// A row of an image with holes.
struct HoleRow {
  const std::uint8_t* wanted = nullptr;  ///< 255 in holes, else 0
  const float* disparity_px = nullptr;   ///< of all other pixels
};

/// Rows farther away do not matter to a row.
inline constexpr int kInterpolationReachRows = 16;

/// Replaces the wanted pixels of rows [first_row, end_row) of an image by means of the background
/// around them, weighted with the inverse square of the distance (D. Shepard, 1968). `rows`: of the
/// image, those out of reach may be null.
///
/// Background of a pixel: the farthest of the ends of its run of wanted pixels in the row and of
/// the next other pixels above and below it within reach; of the two latter, the nearest
/// of three neighbouring columns' counts, so that no single pixel decides. What is nearer by more
/// than the limit is not background. Samples: of the pixel's own row and those 1, 2, 4, 8 and 16
/// rows above and below (up to four times the run's length), the pixel of its column, or, if that
/// is wanted, the next other ones on both sides, at most 64 pixels beyond the run. A row counts for
/// all that it stands for: 1 for the nearest three, then three quarters of its distance.
///
/// A pixel without samples, and a row without other pixels, is unchanged. Integers are rounded half
/// up. Uses scratch memory for a row. T is uint8_t, uint16_t or float.
///
/// Thread rule: may be called concurrently for different rows; reads other pixels of rows in reach.
template <typename T>
void interpolate_background(ImageView<T> image, std::span<const HoleRow> rows, int first_row,
                            int end_row, double gradient_limit_px, Execution& execution);

}  // namespace vantage
