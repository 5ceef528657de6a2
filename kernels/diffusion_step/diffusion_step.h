#pragma once

#include "kernels/star_row.h"

namespace vantage::kernels {

/// One row of linear diffusion: output = own · centre + step · (left + right + up + down)
/// + pull · source, with own = 1 − 4·step − pull. step = λ; pull = λβ for the membrane (6.9), 0 for
/// plain diffusion (6.7), which does not look at the source. Neutral columns are the centre's own:
/// a neighbour that is missing then changes nothing.
/// Lane-wise and without fused operations: identical on every instruction set.
struct DiffusionRow {
  StarRow star;
  float step = 0.15F;
  float pull = 0;
  float* output = nullptr;  ///< star.lanes floats a column; not an input
};

void diffusion_row(const DiffusionRow& row);

/// The same, plainly.
void diffusion_row_ref(const DiffusionRow& row);

}  // namespace vantage::kernels
