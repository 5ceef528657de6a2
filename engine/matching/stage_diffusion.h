#pragma once

#include <memory>

#include "engine/matching/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// One simultaneous (Jacobi) iteration each. Cells are float, geometry.lanes() a column; missing
/// neighbours at the border of the image are absent. The chain's first stage must be the cost stage
/// with the energies E0.

/// Diffusion (6.7), or the membrane (6.9), which also pulls towards E0.
std::unique_ptr<scheduler::RowStage> make_diffusion_stage(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height);

/// Diffusion with local stopping (6.4). `is_last`: leaves the certainty out of the output, whose
/// columns are otherwise one vector longer than the cells.
std::unique_ptr<scheduler::RowStage> make_local_stopping_stage(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    bool is_first, bool is_last);

}  // namespace vantage
