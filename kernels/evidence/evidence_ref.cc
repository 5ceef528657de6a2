#include <algorithm>
#include <cstddef>

#include "kernels/cells/exp_log.h"
#include "kernels/evidence/evidence.h"

namespace vantage::kernels {
void evidence_planes_row_ref(const GradientRowPlanes& row, float alpha, EvidenceNorm norm) {
  for (int x = 0; x < row.width; ++x) {
    row.half_norm[x] = 0.5F * gradient_norm(row.x[x], row.y[x], norm);
    row.x[x] *= alpha;
    row.y[x] *= alpha;
  }
}

void negated_evidence_row_ref(const GradientPairs& row, EvidenceNorm norm, float* cells) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      const int k = j * row.partner_step + i;
      float sum = 0;
      for (int c = 0; c < row.channels; ++c) {
        const auto& [reference, partner] = row.channel[static_cast<std::size_t>(c)];
        sum +=
            gradient_norm(reference[0][j] - partner[0][k], reference[1][j] - partner[1][k], norm) -
            (reference[2][j] + partner[2][k]);
      }
      cells[j * row.lanes + i] = row.channels > 1 ? sum * (1.0F / 3.0F) : sum;
    }
  }
}

void likelihood_of_evidence_ref(const EvidenceRow& row, float sigma, float epsilon, float* cells) {
  const float exponent_scale = kLog2E / sigma;
  for (int j = 0; j < row.columns; ++j, cells += row.geometry.lanes()) {
    const CandidateRange inside = row.geometry.with_partner(row.first_column + j);
    const float min =
        inside.empty() ? 0 : *std::min_element(cells + inside.begin, cells + inside.end);
    for (int i = 0; i < row.geometry.lanes(); ++i) {
      if (i >= inside.begin && i < inside.end) {
        cells[i] = (1.0F - epsilon) * exp2_of_negative((min - cells[i]) * exponent_scale) + epsilon;
      } else {
        cells[i] = i < row.geometry.count ? epsilon : 0;
      }
    }
  }
}

}  // namespace vantage::kernels
