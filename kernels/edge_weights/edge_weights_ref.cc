#include <cmath>

#include "kernels/cells/exp_log.h"
#include "kernels/edge_weights/edge_weights.h"

namespace vantage::kernels {

void edge_weights_row_ref(const float* first, const float* second, int count,
                          const EdgeModel& model, float* weights) {
  const float exponent_of_level = -kLog2E / model.contrast;
  const float rest = 1.0F - model.min;
  for (int x = 0; x < count; ++x) {
    const float difference = std::abs(first[x] - second[x]);
    weights[x] = rest * exp2_of_negative(difference * exponent_of_level) + model.min;
  }
}

void fixed_weights_row_ref(const float* weights, int count, float factor, FixedWeight* fixed) {
  for (int x = 0; x < count; ++x) {
    fixed[x] = fixed_weight(weights[x] * factor);
  }
}

}  // namespace vantage::kernels
