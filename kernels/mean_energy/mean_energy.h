#pragma once

#include <cstdint>

#include "kernels/winner/winner.h"

namespace vantage::kernels {

/// Converts window sums to energies: mean over the samples · scale − offset.
struct EnergyUnit {
  int window_rows = 1;  ///< rows of this row's windows that lie inside the image
  double scale = 1;     ///< > 0
  double offset = 0;
};

/// energies(x, i) = mean cost over the samples of candidate i inside both images (§1): sum /
/// samples · scale − offset, in double, for the candidates of each column; 0 in the other lanes.
/// row.geometry.lanes() per column. Identical on every instruction set.
void mean_energy_row(const WinnerRow& row, const EnergyUnit& unit, float* energies);

/// energy[j] = energy of candidate winners[j] only; NaN for kNoWinner.
void winner_energy_row(const WinnerRow& row, const EnergyUnit& unit, const std::int32_t* winners,
                       float* energy);

}  // namespace vantage::kernels
