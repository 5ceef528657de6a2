#pragma once

#include "kernels/cells/fixed_energy.h"

namespace vantage::kernels {

/// Weight of two neighbouring pixels for each other, given their grey levels: where these differ,
/// there may be a depth discontinuity between them (7.3).
struct EdgeModel {
  float min = 1;       ///< weight across the strongest edges, 0..1
  float contrast = 8;  ///< grey-level difference over which the rest falls to 1/e, > 0
};

/// weights[x] = least + (1 − least) · exp(−|first[x] − second[x]| / contrast), x in [0, count), in
/// [least, 1]. Rows need no alignment. Equal to the reference on every instruction set.
void edge_weights_row(const float* first, const float* second, int count, const EdgeModel& model,
                      float* weights);
void edge_weights_row_ref(const float* first, const float* second, int count,
                          const EdgeModel& model, float* weights);

/// fixed[x] = factor · weights[x] in fixed point, x in [0, count); weights and factor in [0, 1].
/// Rows need no alignment. Equal to the reference on every instruction set.
void fixed_weights_row(const float* weights, int count, float factor, FixedWeight* fixed);
void fixed_weights_row_ref(const float* weights, int count, float factor, FixedWeight* fixed);

}  // namespace vantage::kernels
