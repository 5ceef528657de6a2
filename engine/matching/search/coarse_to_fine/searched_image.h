#pragma once

#include <functional>

#include "engine/matching/chain/match_chain.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// The image whose map is searched over levels, with what its chains read. All must outlive the
/// object.
struct SearchedImage {
  const MethodParameters& parameters;
  const kernels::CandidateGeometry& geometry;  ///< of the image
  const ChainInput& input;                     ///< without ChainInput::pair if there are levels
};

/// Runs one chain after the other.
using RunChain = std::function<void(const MatchChain&)>;

}  // namespace vantage
