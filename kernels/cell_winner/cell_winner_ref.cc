#include "kernels/cell_winner/cell_winner.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vantage::kernels {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

const float* cells_of(const CellRow& row, int j) {
  return row.cells + static_cast<std::ptrdiff_t>(j) * row.geometry.lanes();
}

/// Adds pairs of neighbours until one sum is left.
float pairwise_sum(float (&partial)[kLaneMultiple]) {
  for (int count = kLaneMultiple / 2; count > 0; count /= 2) {
    for (int k = 0; k < count; ++k) {
      partial[k] = partial[2 * k] + partial[2 * k + 1];
    }
  }
  return partial[0];
}

float margin_of(const float* cells, CandidateRange candidates, int winner) {
  float second = std::numeric_limits<float>::infinity();
  float partial[kLaneMultiple] = {};
  for (int i = candidates.begin; i < candidates.end; ++i) {
    partial[i % kLaneMultiple] += cells[i];
    if (i != winner) {
      second = std::min(second, cells[i]);
    }
  }
  const float sum = pairwise_sum(partial);
  const bool single = candidates.end - candidates.begin == 1;
  return single || sum == 0 ? 0 : (second - cells[winner]) / sum;
}

}  // namespace

void select_cell_winners_row_ref(const CellRow& row, const CellWinners& outputs) {
  for (int j = 0; j < row.columns; ++j) {
    const CandidateRange candidates = row.candidates(row.first_column + j);
    const float* cells = cells_of(row, j);
    int winner = kNoWinner;
    for (int i = candidates.begin; i < candidates.end; ++i) {
      if (winner == kNoWinner ||
          (row.probabilities ? cells[i] > cells[winner] : cells[i] < cells[winner])) {
        winner = i;
      }
    }
    if (outputs.winners != nullptr) {
      outputs.winners[j] = winner;
    }
    if (outputs.best != nullptr) {
      outputs.best[j] = winner == kNoWinner ? kUnknown : cells[winner];
    }
    if (outputs.margin != nullptr) {
      outputs.margin[j] = winner == kNoWinner ? kUnknown : margin_of(cells, candidates, winner);
    }
  }
}

void cell_entropy_row_ref(const CellRow& row, const float* best, float scale, float* entropy) {
  for (int j = 0; j < row.columns; ++j) {
    const CandidateRange candidates = row.candidates(row.first_column + j);
    const float* cells = cells_of(row, j);
    // With e = exp(−t), p = e / Σe and log p = −t − log Σe.
    double sum = 0;
    double weighted = 0;
    for (int i = candidates.begin; i < candidates.end; ++i) {
      const double t = scale * (double{cells[i]} - best[j]);
      sum += std::exp(-t);
      weighted += t * std::exp(-t);
    }
    entropy[j] =
        candidates.empty() ? kUnknown : static_cast<float>(0 - (weighted / sum + std::log(sum)));
  }
}

void probability_energy_row_ref(const float* probability, int columns, float* energy) {
  for (int j = 0; j < columns; ++j) {
    energy[j] = static_cast<float>(0 - std::log(double{probability[j]}));
  }
}

}  // namespace vantage::kernels
