#pragma once

#include "kernels/star_row.h"

namespace vantage::kernels {

/// One row of linear diffusion: output = own · centre + Σ step · w_n · neighbour + pull · source,
/// with own = 1 − Σ step · w_n − pull. step = λ; pull = λβ for the membrane (6.9), 0 for plain
/// diffusion (6.7), which does not read the source. Neutral columns equal the centre column, so a
/// missing neighbour has no effect. Lane-wise and without fused operations: identical on every
/// instruction set.
struct DiffusionRow {
  StarRow star;
  float step = 0.15F;
  float pull = 0;
  StarWeights weights = {};  ///< w_n; absent: all are 1
  float* output = nullptr;   ///< star.lanes floats per column; must not overlap the input
};

void diffusion_row(const DiffusionRow& row);

}  // namespace vantage::kernels
