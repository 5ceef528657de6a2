#pragma once

#include <memory>

#include "engine/matching/levels/level_volume.h"
#include "engine/matching/selection/row_energies.h"
#include "engine/matching/selection/stage_cell_selection.h"
#include "engine/matching/selection/symmetric_energies.h"
#include "scheduler/row_stage.h"

namespace vantage {

struct SymmetricSettings {
  EnergySteps steps;
  Subpixel subpixel = Subpixel::kParabola;
  ConfidenceMeasure confidence = ConfidenceMeasure::kMargin;
  float entropy_scale = 1;  ///< see CellSelectionSettings
};

/// Last stage of the left image's chain: matches the pixels of a row of both images one to one, or
/// leaves them unmatched (§3.17). `energies`: of the left image; `right`: those of the right image
/// in steps (make_symmetric_store_stage). Both maps have the same disparity at both pixels of a
/// match, and NaN at unmatched pixels; so have energies, and confidences that are evidence or
/// probability. Margin and entropy are of all energies of the pixel. Needs whole rows. Views and
/// `right` outlive the stage.
std::unique_ptr<scheduler::RowStage> make_symmetric_selection_stage(
    std::unique_ptr<RowEnergies> energies, const LevelVolume& right,
    const SymmetricSettings& settings, const MapOutputs& left_outputs,
    const MapOutputs& right_outputs);

}  // namespace vantage
