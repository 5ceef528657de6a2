#pragma once

#include <memory>

#include "engine/image/image.h"
#include "engine/matching/costs/stage_cost.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Disparities that attract pixels, see kernels/disparity_prior.
struct PriorPull {
  /// NaN or outside the range for pixels without a prior; of the size of the costs.
  ImageView<const float> prior_px;
  float weight = 1;         ///< ≥ 0
  float max_contrast = 0;   ///< for energies only
  int first_candidate = 0;  ///< if cells are likelihoods: the first that the costs hold
};

/// Source stage: the cells of the source stage `costs`, with every pixel that has a prior disparity
/// pulled towards it. What `pull` views must outlive the stage. `geometry`: of all candidates.
/// Later stages that read the source again see the same cells.
std::unique_ptr<scheduler::RowStage> make_disparity_prior_stage(
    std::unique_ptr<scheduler::RowStage> costs, const kernels::CandidateGeometry& geometry,
    CellMeaning meaning, const PriorPull& pull);

}  // namespace vantage
