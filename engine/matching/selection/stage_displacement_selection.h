#pragma once

#include <memory>

#include "engine/matching/costs/displacement_grid.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "engine/matching/selection/stage_window_selection.h"
#include "scheduler/row_stage.h"

namespace vantage {

// Last stages of a two-dimensional search: each selects among all displacements of a grid that have
// a partner, ties going to the first, and optionally refines both components by a parabola (§3)
// through the neighbours in their direction. Confidence covers all these candidates. Input columns
// have grid.columns().lanes() cells. Both components are written, NaN where there is no candidate.

/// From float cells, as make_cell_selection_stage().
std::unique_ptr<scheduler::RowStage> make_displacement_selection_stage(
    const DisplacementGrid& grid, const CellSelectionSettings& settings, const MapOutputs& outputs);

/// From fixed-point energies, as make_fixed_energy_selection_stage().
std::unique_ptr<scheduler::RowStage> make_displacement_fixed_energy_selection_stage(
    const DisplacementGrid& grid, Subpixel subpixel, float steps_per_nat,
    const MapOutputs& outputs);

/// From the sums of make_displacement_sum_stage(), as make_window_selection_stage(); candidates are
/// compared by their mean costs, rounded to float. settings.index_bits is 0.
std::unique_ptr<scheduler::RowStage> make_displacement_window_selection_stage(
    const DisplacementGrid& grid, const WindowSelectionSettings& settings,
    const MapOutputs& outputs);

}  // namespace vantage
