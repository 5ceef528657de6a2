#pragma once

#include "engine/matching/aggregation/edge_weights.h"
#include "engine/matching/levels/candidate_blocks.h"
#include "engine/matching/levels/level_volume.h"
#include "kernels/candidates.h"

namespace vantage {

/// The context of an aggregation: one level of one map. What it points to outlives the stages.
struct AggregationPlace {
  const kernels::CandidateGeometry& geometry;
  int height = 0;
  kernels::CandidatePlane plane = {};  ///< of a two-dimensional search
  const EdgeWeights* edges = nullptr;  ///< null: neighbours have equal weights
  /// Final cells of the next coarser level, from which the level starts; null: none.
  const LevelVolume* coarser = nullptr;
  const CandidateBlocks* coarser_blocks = nullptr;
  const CandidateBlocks* blocks = nullptr;  ///< null: all candidates are searched
};

}  // namespace vantage
