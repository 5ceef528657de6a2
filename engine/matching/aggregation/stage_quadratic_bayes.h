#pragma once

#include <memory>
#include <vector>

#include "engine/matching/aggregation/aggregation_place.h"
#include "engine/matching/parameters/method_parameters.h"
#include "scheduler/row_stage.h"

namespace vantage {

/// make_bayes_stages() for the quadratic prior (Prior::kQuadratic), with the sum or its largest
/// term: same cells, arguments and results.
std::vector<std::unique_ptr<scheduler::RowStage>> make_quadratic_bayes_stages(
    const MethodParameters& parameters, const AggregationPlace& place);

}  // namespace vantage
