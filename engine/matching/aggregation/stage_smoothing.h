#pragma once

#include <memory>
#include <vector>

#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// Means over square windows of 2·radius + 1 pixels, cut to the image, as float cells,
/// geometry.lanes() per column: first down columns, then along rows. For coarse levels, whose
/// results are cells; for winners, stage_column_sum and stage_window_selection are faster. All
/// candidates count as having partners.
std::vector<std::unique_ptr<scheduler::RowStage>> make_box_mean_stages(
    const kernels::CandidateGeometry& geometry, int height, int radius);

/// Convolves float cells (geometry.lanes() per column) with a Gaussian of `sigma_px` in x and y,
/// cells outside the image being 0: sampled, normalised, radius ⌈4σ⌉.
std::vector<std::unique_ptr<scheduler::RowStage>> make_gaussian_stages(
    const kernels::CandidateGeometry& geometry, int height, double sigma_px);

/// As make_gaussian_stages() with Wells' cascade: four box filters of odd widths whose variances
/// add up to σ² as closely as odd widths allow (σ = 2: 3, 3, 3, 5, exactly). It is one composite
/// kernel, so that cells outside the image count once, as 0. Normalised. 3, 3, 3, 5 is one stage
/// that stores nothing between the two directions; other widths cost as much as a Gaussian of their
/// radius.
std::vector<std::unique_ptr<scheduler::RowStage>> make_box_cascade_stages(
    const kernels::CandidateGeometry& geometry, int height, double sigma_px);

}  // namespace vantage
