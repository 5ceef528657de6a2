#pragma once

#include "engine/matching/options/method_parameters.h"

namespace vantage {

/// Between which values the cells of a cost stage lie.
struct CostBounds {
  float least = 0;
  float largest = 0;
};

/// For grey levels of 0..255 and the sum of the costs of `partners` images.
CostBounds cost_bounds(const MethodParameters& parameters, int partners);

}  // namespace vantage
