#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/candidates.h"
#include "kernels/winner/winner.h"

namespace vantage::kernels {

/// One row of float cells and what they mean. Cells of candidates are finite; what other lanes hold
/// does not matter.
struct CellRow {
  const float* cells = nullptr;  ///< first cell of first_column; geometry.lanes() a column
  CandidateGeometry geometry;
  int first_column = 0;
  int columns = 0;
  /// Candidates count if pixel and partner lie at least so many columns inside their images: the
  /// radius where only whole windows count.
  int margin = 0;
  /// Cells are probabilities in [0, 1] and the largest wins; else energies, and the least wins.
  bool probabilities = false;

  /// Candidates that may win at column x.
  [[nodiscard]] CandidateRange candidates(int x) const {
    if (x < margin || x >= geometry.width - margin) {
      return {};
    }
    return geometry.with_partner(x, margin);
  }
  /// The columns [begin, end) of this row at which every candidate may win.
  [[nodiscard]] CandidateRange plain_columns() const {
    const CandidateRange all = geometry.columns_with_all_partners(margin);
    const int last = first_column + columns;
    const int begin = std::clamp(std::max(all.begin, margin), first_column, last);
    return {begin, std::clamp(std::min(all.end, geometry.width - margin), begin, last)};
  }
};

/// What is wanted of a row: one value per column each, null where not wanted.
struct CellWinners {
  /// Index of the best candidate, the smallest of equals; kNoWinner where no candidate counts.
  std::int32_t* winners = nullptr;
  /// Its cell; NaN where no candidate counts.
  float* best = nullptr;
  /// Of energies, winner margin (6.13): (Emin2 − Emin) / Σ E over the candidates, Emin2 the second
  /// smallest element; 0 where Σ E = 0 or there is one candidate, NaN where there is none.
  float* margin = nullptr;
};

/// Writes what is wanted of `row`. Sums are added up as sixteen partial sums over every sixteenth
/// candidate, then pairwise: identical on every instruction set.
void select_cell_winners_row(const CellRow& row, const CellWinners& outputs);

/// Of energies, negative entropy (6.15): entropy[j] = Σ p log p ≤ 0 with
/// p ∝ exp(−scale · (E − Emin)) over the candidates of column first_column + j; NaN where there is
/// none. `best`: the least energies, as select_cell_winners_row() writes them. scale ≥ 0. To 1e-5;
/// identical on every instruction set.
void cell_entropy_row(const CellRow& row, const float* best, float scale, float* entropy);

/// energy[j] = −log probability[j]: infinity for 0, NaN for NaN. Identical on every instruction
/// set. May be the same memory.
void probability_energy_row(const float* probability, int columns, float* energy);

/// The same, plainly.
void select_cell_winners_row_ref(const CellRow& row, const CellWinners& outputs);
void cell_entropy_row_ref(const CellRow& row, const float* best, float scale, float* entropy);
void probability_energy_row_ref(const float* probability, int columns, float* energy);

}  // namespace vantage::kernels
