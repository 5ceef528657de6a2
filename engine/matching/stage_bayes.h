#pragma once

#include <memory>
#include <vector>

#include "engine/matching/level_volume.h"
#include "engine/matching/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// The stages of Bayesian diffusion (6.25)–(6.37) after the chain's first stage, which must be the
/// cost stage with likelihoods (CellMeaning::kLikelihood): a start, then one stage an iteration.
/// The last one's cells are probabilities, float, geometry.lanes() a column, that sum to 1; lanes
/// that are no candidates hold 0.
///
/// `coarser`: the probabilities that the next coarser level ended with (stage_level_likelihoods),
/// which must outlive the stages; the start is then made of them instead of the likelihoods, which
/// only the iterations look at. Null: there is no coarser level.
///
/// μ = ½ takes the form without exponentials and logarithms, unless εP is so small (below 1e-7)
/// that the product of five smoothed probabilities could leave the range of normal floats.
std::vector<std::unique_ptr<scheduler::RowStage>> make_bayes_stages(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    const LevelVolume* coarser = nullptr);

}  // namespace vantage
