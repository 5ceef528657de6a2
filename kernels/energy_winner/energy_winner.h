#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "kernels/candidates.h"
#include "kernels/cells/fixed_energy.h"
#include "kernels/winner/winner.h"

namespace vantage::kernels {

// Selection among fixed-point energies. All functions are identical on every instruction set.

/// One row of columns of energies, aligned to kLaneMultiple cells. Lanes that are not candidates
/// are not below any candidate.
struct EnergyRow {
  const FixedEnergy* cells = nullptr;  ///< lane 0 of first_column
  /// Cells between columns, ≥ geometry.lanes(), a multiple of kLaneMultiple.
  std::ptrdiff_t pitch = 0;
  CandidateGeometry geometry;  ///< at most 32752 candidates
  int first_column = 0;
  int columns = 0;

  /// Candidates of column x that may win: those with a partner.
  [[nodiscard]] CandidateRange candidates(int x) const { return geometry.with_partner(x); }
  /// Columns [begin, end) of this row where every candidate may win.
  [[nodiscard]] CandidateRange plain_columns() const {
    const CandidateRange all = geometry.columns_with_all_partners();
    const int last = first_column + columns;
    const int begin = std::clamp(all.begin, first_column, last);
    return {begin, std::clamp(all.end, begin, last)};
  }
};

/// winners[j]: the candidate with the minimum energy, the smallest on ties; kNoWinner where none
/// may win. least[j]: its energy; kMaxEnergy where none may win.
void select_energy_winners_row(const EnergyRow& row, std::int32_t* winners, FixedEnergy* min);

/// disparity_px[j] is the disparity of winners[j], NaN where there is none. refined: moved to the
/// vertex of the parabola through the energies of the winner and its neighbours, EQUATIONS §3; not
/// moved where a neighbour may not win or where the curvature is not positive.
void energy_disparity_row(const EnergyRow& row, const std::int32_t* winners, bool refined,
                          float* disparity_px);

/// Columns of energies above their minimum, whether or not candidates have partners.
struct EnergyColumnsRow {
  const FixedEnergy* cells = nullptr;
  std::ptrdiff_t pitch = 0;
  int columns = 0;
  int lanes = 0;  ///< a multiple of kLaneMultiple
};

/// probability[j] = exp(−least[j]/s) / Σ exp(−E/s) over the column, with s steps per nat; NaN where
/// least[j] is kMaxEnergy. The float sum is sixteen partial sums, each over every sixteenth lane,
/// then added pairwise. Error below 1e-5, down to 2^−125, the smallest value returned.
void energy_probability_row(const EnergyColumnsRow& row, const FixedEnergy* min,
                            float steps_per_nat, float* probability);

}  // namespace vantage::kernels
