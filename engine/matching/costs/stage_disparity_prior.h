#pragma once

#include <memory>

#include "engine/image/image.h"
#include "engine/matching/costs/stage_cost.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Source stage: the cells of the source stage `costs`, with every pixel that has a prior disparity
/// pulled towards it (kernels/disparity_prior). `prior_px`: NaN or outside the range for pixels
/// without a prior; of the size of `costs`; must outlive the stage. `geometry`: of all candidates;
/// if cells are likelihoods, `costs` may hold only those from `first_candidate` on. weight ≥ 0;
/// max_contrast: see kernels/disparity_prior, for energies only. Later stages that read the source
/// again see the same cells.
std::unique_ptr<scheduler::RowStage> make_disparity_prior_stage(
    std::unique_ptr<scheduler::RowStage> costs, const kernels::CandidateGeometry& geometry,
    CellMeaning meaning, ImageView<const float> prior_px, float weight, float max_contrast,
    int first_candidate = 0);

}  // namespace vantage
