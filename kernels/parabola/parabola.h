#pragma once

#include <cstdint>

#include "kernels/winner/winner.h"

namespace vantage::kernels {

/// disparity_px[j] = disparity of winners[j], NaN where there is none.
void integer_disparity_row(const WinnerRow& row, const std::int32_t* winners, float* disparity_px);

/// The same moved to the lowest point of the parabola through the energies of the winner and its
/// two neighbours: δ = (E₋ − E₊) / (2(E₋ − 2E₀ + E₊)), EQUATIONS §3. No move where a neighbour is
/// outside the range or is no candidate, or where the curvature is not positive. Computed in
/// double; |δ| ≤ ½ at a minimum.
void parabola_disparity_row(const WinnerRow& row, const std::int32_t* winners, float* disparity_px);

}  // namespace vantage::kernels
