#pragma once

#include "engine/matching/parameters/method_parameters.h"

namespace vantage {

/// ρP(k) of the parameters' prior (6.18), in nats: what a difference of k pixels between the
/// disparities of neighbours costs. 0 for k = 0.
double prior_penalty(const MethodParameters& parameters, double offset_px);

}  // namespace vantage
