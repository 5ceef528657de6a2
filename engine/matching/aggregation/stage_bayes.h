#pragma once

#include <memory>
#include <vector>

#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/levels/level_volume.h"
#include "engine/matching/options/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// The stages of Bayesian diffusion (6.25)–(6.37) after the chain's first stage, which must be the
/// cost stage with likelihoods (CellMeaning::kLikelihood): a start, then one stage an iteration.
/// The last one's cells are probabilities, float, geometry.lanes() a column, that sum to 1; lanes
/// that are no candidates hold 0.
///
/// `coarser`, the probabilities that the next coarser level ended with (stage_level_likelihoods),
/// must outlive the stages; the start is made of it instead of the likelihoods, which
/// then only the iterations look at. Null: there is no coarser level.
///
/// `edges`: of the image of this level, which must outlive the stages: they weight neighbours
/// (7.3), p ∝ p0 · Π pS^(μ·w) with w = 1 for the column itself. Null: all neighbours count 1.
///
/// `plane`: of a search in two dimensions; the prior is then one of the length of an offset.
///
/// μ = ½ takes the form without exponentials and logarithms, unless neighbours are weighted or εP
/// is so small (below 1e-7) that the product of five smoothed probabilities could leave the range
/// of normal floats.
std::vector<std::unique_ptr<scheduler::RowStage>> make_bayes_stages(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    const LevelVolume* coarser = nullptr, const EdgeWeights* edges = nullptr,
    const kernels::CandidatePlane& plane = {});

}  // namespace vantage
