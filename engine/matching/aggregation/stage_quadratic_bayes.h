#pragma once

#include <memory>
#include <vector>

#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/levels/level_volume.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// make_bayes_stages() for the quadratic prior (Prior::kQuadratic), with the sum or its largest
/// term: same cells, arguments and results.
std::vector<std::unique_ptr<scheduler::RowStage>> make_quadratic_bayes_stages(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry, int height,
    const LevelVolume* coarser, const EdgeWeights* edges, const kernels::CandidatePlane& plane);

}  // namespace vantage
