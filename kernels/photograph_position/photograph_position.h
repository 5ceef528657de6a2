#pragma once

#include <cstddef>

#include "kernels/source_position/source_position.h"

namespace vantage::kernels {

/// Where the pixels of a rectified image lie in the photograph it was made from.
struct PhotographTable {
  const float* x_px = nullptr;  ///< of the rectified pixel (0, 0); NaN = the camera does not see it
  const float* y_px = nullptr;
  std::ptrdiff_t stride = 0;  ///< values from one row of the tables to the next
  int width = 0;              ///< of the rectified image, 1..65500
  int height = 0;             ///< likewise
  int photograph_width = 0;   ///< ≥ 1
  int photograph_height = 0;  ///< ≥ 1
};

/// Turns `count` positions in the rectified image, as source_positions_row() makes them, into
/// positions in the photograph, in place: linearly between the four pixels of the table around
/// each, at its borders carried on from the outermost two. `nearness` is not looked at.
///
/// A place that the camera does not see, or more than half a pixel outside the photograph, gets NaN
/// in `disparity_px` and the position (0, 0), as holes have it: nothing can be fetched there, and
/// the rectified image is black. Identical on every instruction set and to the reference.
void photograph_positions_row(const PhotographTable& table, const SourcePositions& positions,
                              int count);
void photograph_positions_row_ref(const PhotographTable& table, const SourcePositions& positions,
                                  int count);

}  // namespace vantage::kernels
