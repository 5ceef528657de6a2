#include <cstddef>
#include <limits>

#include "kernels/mean_energy/mean_energy.h"

namespace vantage::kernels {
namespace {

// Uses the same factor for the same number of samples, so that equal sums give equal energies.
float mean_energy(const WinnerRow& row, const EnergyUnit& unit, int x, std::int32_t cell,
                  int candidate) {
  const double factor = unit.scale / (unit.window_rows * row.window_columns(x, candidate));
  return static_cast<float>(row.sum(cell) * factor - unit.offset);
}

}  // namespace

void mean_energy_row_ref(const WinnerRow& row, const EnergyUnit& unit, float* energies) {
  const int lanes = row.geometry.lanes();
  const std::int32_t* cells = row.cells;
  for (int j = 0; j < row.columns; ++j, cells += lanes, energies += lanes) {
    const int x = row.first_column + j;
    const CandidateRange candidates = row.candidates(x);
    for (int i = 0; i < lanes; ++i) {
      const bool counts = i >= candidates.begin && i < candidates.end;
      energies[i] = counts ? mean_energy(row, unit, x, cells[i], i) : 0;
    }
  }
}

void winner_energy_row(const WinnerRow& row, const EnergyUnit& unit, const std::int32_t* winners,
                       float* energy) {
  const std::ptrdiff_t lanes = row.geometry.lanes();
  for (int j = 0; j < row.columns; ++j) {
    energy[j] = winners[j] == kNoWinner
                    ? std::numeric_limits<float>::quiet_NaN()
                    : mean_energy(row, unit, row.first_column + j,
                                  row.cells[j * lanes + winners[j]], winners[j]);
  }
}

}  // namespace vantage::kernels
