#include <algorithm>

#include "kernels/cells/exp_log.h"
#include "kernels/disparity_prior/disparity_prior.h"

namespace vantage::kernels {
namespace {

/// min(k²/4, 1) for candidate i.
float share_of_depth(const DisparityPriorRow& row, int column, int i) {
  const float k = (static_cast<float>(i) - row.candidate(column)) * row.inverse_reach();
  return std::min(k * k, 1.0F);
}

/// Sums every sixteenth lane, then reduces the sixteen sums by the tree of lane_sums-inl.h.
float mean_above_min(const float* cells, int count) {
  float sums[kLaneMultiple] = {};
  float min = cells[0];
  for (int i = 0; i < count; ++i) {
    sums[i % kLaneMultiple] += cells[i];
    min = std::min(min, cells[i]);
  }
  for (int half = kLaneMultiple / 2; half >= 1; half /= 2) {
    for (int i = 0; i < half; ++i) {
      sums[i] += sums[i + half];
    }
  }
  return std::max(sums[0] / static_cast<float>(count) - min, 0.0F);
}

}  // namespace

void energies_with_prior_row_ref(const DisparityPriorRow& row, float* cells) {
  for (int j = 0; j < row.columns; ++j, cells += row.lanes) {
    if (!row.has_prior(j)) {
      continue;
    }
    const float scale = row.weight * std::min(mean_above_min(cells, row.count), row.max_contrast);
    for (int i = 0; i < row.lanes; ++i) {
      cells[i] += scale * share_of_depth(row, j, i);
    }
  }
}

void likelihoods_with_prior_row_ref(const DisparityPriorRow& row, float* cells) {
  const float exponent_scale = prior_exponent_scale(row.weight);
  for (int j = 0; j < row.columns; ++j, cells += row.lanes) {
    if (!row.has_prior(j)) {
      continue;
    }
    for (int i = 0; i < row.lanes; ++i) {
      cells[i] *=
          exp2_of_negative(exponent_scale * share_of_depth(row, j, row.first_candidate + i));
    }
  }
}

}  // namespace vantage::kernels
