#include <algorithm>

#include "kernels/evidence_sum/evidence_sum.h"

namespace vantage::kernels {

double pairwise_sum(const float* lanes) {
  double sums[kLaneMultiple];
  std::copy_n(lanes, kLaneMultiple, sums);
  for (int half = kLaneMultiple / 2; half > 0; half /= 2) {
    for (int lane = 0; lane < half; ++lane) {
      sums[lane] += sums[lane + half];
    }
  }
  return sums[0];
}

double evidence_sum_ref(const EvidenceBlock& block) {
  const auto& [reference, partner, columns, rows, norm] = block;
  float lanes[kLaneMultiple] = {};
  for (int row = 0; row < rows; ++row) {
    for (int j = 0; j < columns; ++j) {
      const std::ptrdiff_t at = row * reference.row_stride + j;
      const std::ptrdiff_t partner_at = row * partner.row_stride + j;
      const float dx = reference.x[at] - partner.x[partner_at];
      const float dy = reference.y[at] - partner.y[partner_at];
      lanes[j % kLaneMultiple] +=
          reference.half_norm[at] + partner.half_norm[partner_at] - gradient_norm(dx, dy, norm);
    }
  }
  return pairwise_sum(lanes);
}

}  // namespace vantage::kernels
