#pragma once

#include <cstdint>

#include "kernels/cell_winner/cell_winner.h"
#include "kernels/winner/winner.h"

namespace vantage::kernels {

/// disparity_px[j] = disparity of winners[j], NaN where there is none.
void integer_disparity_row(const WinnerRow& row, const std::int32_t* winners, float* disparity_px);
void integer_disparity_row(const CellRow& row, const std::int32_t* winners, float* disparity_px);

/// Same, moved to the vertex of the parabola through the energies of the winner and its two
/// neighbours: δ = (E₋ − E₊) / (2(E₋ − 2E₀ + E₊)), EQUATIONS §3. Not moved if a neighbour is
/// outside the range or is no candidate, or if the curvature is not positive. For probabilities: E
/// = −log p, and not moved if one of the three is 0. Computed in double; |δ| ≤ ½ at a minimum.
/// Identical on every instruction set.
void parabola_disparity_row(const WinnerRow& row, const std::int32_t* winners, float* disparity_px);
void parabola_disparity_row(const CellRow& row, const std::int32_t* winners, float* disparity_px);

/// Scalar reference.
void parabola_disparity_row_ref(const WinnerRow& row, const std::int32_t* winners,
                                float* disparity_px);
void parabola_disparity_row_ref(const CellRow& row, const std::int32_t* winners,
                                float* disparity_px);

}  // namespace vantage::kernels
