#pragma once

#include <memory>

#include "engine/matching/selection/row_energies.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "kernels/scanline/scanline.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Selection by dynamic programming along rows (§3.15).
struct ScanlineSettings {
  kernels::JumpCost jump;
  Subpixel subpixel = Subpixel::kParabola;
  ConfidenceMeasure confidence = ConfidenceMeasure::kMargin;
  float entropy_scale = 1;  ///< see CellSelectionSettings
};

/// Last stage: selects the disparities of a row together: those with the smallest sum of energies
/// and of costs of changes between neighbours. NaN where no candidate counts. Sub-pixel as for
/// winners, at most half a pixel from the selected candidate. Energy, evidence and probability are
/// those of the selected candidate, margin and entropy those of all energies of the pixel. Needs
/// whole rows.
std::unique_ptr<scheduler::RowStage> make_scanline_selection_stage(
    std::unique_ptr<RowEnergies> energies, const ScanlineSettings& settings,
    const MapOutputs& outputs);

}  // namespace vantage
