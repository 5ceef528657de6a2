#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/candidates.h"
#include "kernels/winner/winner.h"

namespace vantage::kernels {

/// One row of float cells and their meaning. Cells of candidates are finite; other lanes may hold
/// anything.
struct CellRow {
  const float* cells = nullptr;  ///< first cell of first_column; geometry.lanes() per column
  CandidateGeometry geometry;
  int first_column = 0;
  int columns = 0;
  /// Candidates count if pixel and partner lie at least this many columns inside their images; the
  /// window radius where only whole windows count.
  int margin = 0;
  /// true: cells are probabilities in [0, 1] and the maximum wins; false: energies, the minimum
  /// wins.
  bool probabilities = false;

  /// Candidates of column x that may win.
  [[nodiscard]] CandidateRange candidates(int x) const {
    if (x < margin || x >= geometry.width - margin) {
      return {};
    }
    return geometry.with_partner(x, margin);
  }
  /// Columns [begin, end) of this row where every candidate may win.
  [[nodiscard]] CandidateRange plain_columns() const {
    const CandidateRange all = geometry.columns_with_all_partners(margin);
    const int last = first_column + columns;
    const int begin = std::clamp(std::max(all.begin, margin), first_column, last);
    return {begin, std::clamp(std::min(all.end, geometry.width - margin), begin, last)};
  }
};

/// Requested outputs of a row: one value per column each; null: not requested.
struct CellWinners {
  /// Index of the best candidate, the smallest on ties; kNoWinner where no candidate counts.
  std::int32_t* winners = nullptr;
  /// Cell of the winner; NaN where no candidate counts.
  float* best = nullptr;
  /// For energies: winner margin (6.13), (Emin2 − Emin) / Σ E over the candidates, with Emin2 the
  /// second smallest element. 0 where Σ E = 0 or there is one candidate; NaN where there is none.
  float* margin = nullptr;
};

/// Writes the requested outputs of `row`. Sums are sixteen partial sums, each over every sixteenth
/// candidate, then added pairwise: identical on every instruction set.
void select_cell_winners_row(const CellRow& row, const CellWinners& outputs);

/// For energies: negative entropy (6.15), entropy[j] = Σ p log p ≤ 0 with p ∝ exp(−scale · (E −
/// Emin)) over the candidates of column first_column + j; NaN where there is none. `best`: minimum
/// energies from select_cell_winners_row(). scale ≥ 0. Error below 1e-5; identical on every
/// instruction set.
void cell_entropy_row(const CellRow& row, const float* best, float scale, float* entropy);

/// energy[j] = −log probability[j]: infinity for 0, NaN for NaN. Identical on every instruction
/// set. Input and output may be the same memory.
void probability_energy_row(const float* probability, int columns, float* energy);

}  // namespace vantage::kernels
