#pragma once

#include <memory>

#include "engine/image/image.h"
#include "engine/matching/costs/stage_cost.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Source stage: the cells of `costs`, a source stage of such cells, after every pixel with a prior
/// disparity has been drawn towards it (kernels/disparity_prior). `prior_px`: NaN, or a value
/// outside the range, where a pixel has none; of the size of `costs`; must outlive the stage.
/// `geometry`: of all candidates; `costs` may hold those from `first_candidate` on only where cells
/// are likelihoods. weight ≥ 0; max_contrast: see kernels/disparity_prior, for energies only. All
/// later stages that look at the source again see the same cells.
std::unique_ptr<scheduler::RowStage> make_disparity_prior_stage(
    std::unique_ptr<scheduler::RowStage> costs, const kernels::CandidateGeometry& geometry,
    CellMeaning meaning, ImageView<const float> prior_px, float weight, float max_contrast,
    int first_candidate = 0);

}  // namespace vantage
