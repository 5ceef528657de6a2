#include <cmath>
#include <limits>

#include "kernels/energy_winner/energy_winner.h"

namespace vantage::kernels {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

}  // namespace

void select_energy_winners_row_ref(const EnergyRow& row, std::int32_t* winners, FixedEnergy* min) {
  for (int j = 0; j < row.columns; ++j) {
    const FixedEnergy* const cells = row.cells + j * row.pitch;
    const CandidateRange candidates = row.candidates(row.first_column + j);
    winners[j] = candidates.empty() ? kNoWinner : candidates.begin;
    for (int i = candidates.begin; i < candidates.end; ++i) {
      if (cells[i] < cells[winners[j]]) {
        winners[j] = i;
      }
    }
    min[j] = candidates.empty() ? kMaxEnergy : cells[winners[j]];
  }
}

void energy_disparity_row(const EnergyRow& row, const std::int32_t* winners, bool refined,
                          float* disparity_px) {
  const CandidateRange plain = row.plain_columns();
  for (int j = 0; j < row.columns; ++j) {
    const int winner = winners[j];
    if (winner == kNoWinner) {
      disparity_px[j] = kUnknown;
      continue;
    }
    disparity_px[j] = static_cast<float>(row.geometry.disparity_min + winner);
    const int x = row.first_column + j;
    const CandidateRange candidates = x >= plain.begin && x < plain.end
                                          ? CandidateRange{0, row.geometry.count}
                                          : row.candidates(x);
    if (!refined || winner <= candidates.begin || winner + 1 >= candidates.end) {
      continue;
    }
    const FixedEnergy* const at = row.cells + j * row.pitch + winner;
    const int curvature = at[-1] - 2 * at[0] + at[1];
    // No branch: whether the curvature is positive is hard to predict.
    const auto slope = static_cast<float>(curvature > 0 ? at[-1] - at[1] : 0);
    disparity_px[j] += slope / static_cast<float>(curvature > 0 ? 2 * curvature : 1);
  }
}

void energy_probability_row_ref(const EnergyColumnsRow& row, const FixedEnergy* min,
                                float steps_per_nat, float* probability) {
  for (int j = 0; j < row.columns; ++j) {
    const FixedEnergy* const cells = row.cells + j * row.pitch;
    double sum = 0;
    for (int i = 0; i < row.lanes; ++i) {
      sum += std::exp(-cells[i] / static_cast<double>(steps_per_nat));
    }
    const double winner = std::exp(-min[j] / static_cast<double>(steps_per_nat));
    probability[j] = min[j] == kMaxEnergy ? kUnknown : static_cast<float>(winner / sum);
  }
}

}  // namespace vantage::kernels
