#pragma once

#include <cstddef>

#include "kernels/source_position/source_position.h"

namespace vantage::kernels {

/// Positions of the pixels of a rectified image in the photograph it was made from.
struct PhotographTable {
  const float* x_px = nullptr;  ///< at the rectified pixel (0, 0); NaN = not seen by the camera
  const float* y_px = nullptr;
  std::ptrdiff_t stride = 0;  ///< values between rows of the tables
  int width = 0;              ///< of the rectified image, 1..65500
  int height = 0;             ///< likewise
  int photograph_width = 0;   ///< ≥ 1
  int photograph_height = 0;  ///< ≥ 1
};

/// Converts `count` positions in the rectified image (from source_positions_row()) to positions in
/// the photograph, in place: bilinear between the four surrounding table entries, extrapolated at
/// the borders from the outermost two. `nearness` is not read.
///
/// A position that the camera does not see, or more than half a pixel outside the photograph, gets
/// NaN in `disparity_px` and position (0, 0), like a hole: nothing can be fetched there, and the
/// rectified image is black. Identical on every instruction set and to the reference.
void photograph_positions_row(const PhotographTable& table, const SourcePositions& positions,
                              int count);
void photograph_positions_row_ref(const PhotographTable& table, const SourcePositions& positions,
                                  int count);

}  // namespace vantage::kernels
