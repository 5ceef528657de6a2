#pragma once

#include <memory>
#include <vector>

#include "engine/matching/aggregation/aggregation_place.h"
#include "engine/matching/parameters/method_parameters.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// The stages of Bayesian diffusion (6.25)–(6.37) after the chain's first stage, which must be the
/// cost stage with likelihoods (CellMeaning::kLikelihood): a start, then one stage per iteration.
/// The output cells are float probabilities, geometry.lanes() per column, that sum to 1; padding
/// lanes hold 0.
///
/// `place.coarser`: the final probabilities of the next coarser level (stage_level_likelihoods).
/// The start is then made from it instead of the likelihoods, which only the iterations read.
///
/// `place.edges`: weights of neighbours on this level (7.3), p ∝ p0 · Π pS^(μ·w) with w = 1 for the
/// column itself.
///
/// `place.plane`: of a two-dimensional search; the prior then depends on the length of an offset.
///
/// μ = ½ uses the form without exponentials and logarithms, unless neighbours are weighted or εP is
/// so small (below 1e-7) that the product of five smoothed probabilities could leave the range of
/// normal floats.
std::vector<std::unique_ptr<scheduler::RowStage>> make_bayes_stages(
    const MethodParameters& parameters, const AggregationPlace& place);

}  // namespace vantage
