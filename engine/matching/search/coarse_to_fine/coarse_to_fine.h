#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/matching/chain/match_chain.h"
#include "engine/matching/search/coarse_to_fine/coarse_levels.h"
#include "engine/matching/search/coarse_to_fine/searched_parts.h"
#include "kernels/candidates.h"
#include "scheduler/range.h"

namespace vantage {

/// Number of aggregated cells.
struct LevelCells {
  double all_levels = 0;
  double finest_level = 0;
};

/// The map of a coarse level, in addition to the image's own or instead of it.
struct CoarseMap {
  int level = 0;  ///< 1 to the coarsest level; 0: not requested
  /// Resized to the level: numbers of candidates; pixels without a partner have one, too.
  Image<std::int32_t>* winners = nullptr;
  /// No finer level is computed; of the outputs, only the size is used.
  bool is_only = false;
};

/// What the other image's map is checked against, beside the map: the disparities of the map, but
/// in smooth tiles of the finest level the winners of level 1, each repeated over its pixels. Only
/// if has_check_map().
struct CheckMap {
  ImageView<float> disparity_px = {};  ///< image-sized; empty: not requested
  /// Only the check map is needed. It may then be the map itself, whose smooth tiles are not
  /// computed.
  bool is_only = false;
};

/// Whether the finest level of images of `extent` can do without its smooth_tiles(): it is searched
/// in windows, or pruned with at most one iteration.
bool has_check_map(const MethodParameters& parameters, scheduler::Extent extent);

/// Computes one map coarse to fine (6.7). Costs are reduced level by level: energies −ln p0 are
/// summed over blocks of 2×2 columns for Bayesian diffusion (times level_weight) and averaged for
/// other methods. Then the levels are aggregated, coarsest first, each starting from the coarser
/// level's result: Bayesian diffusion with its probabilities (or their energies) as the first state
/// and its own likelihoods, the membrane with its energies and the pull of its own costs, all
/// others with the mean of their own costs and its energies. Number and unit of disparities are the
/// same on all levels. The finest level's costs are computed from the images twice and never
/// stored. Iterations and σP depend on the level (at_level).
///
/// `run` is called with one chain after the other: the first reduces the image's costs (or a band
/// of them, LevelBands) unless stored ones are used (ChainInput::sharing), the last, without
/// windows, selects winners into `outputs`. parameters.levels > 1; geometry and outputs are the
/// image's; input without ChainInput::pair.
///
/// With parameters.candidate_blocks > 0 the finest `pruned_levels` levels (never the coarsest)
/// process only a few candidate blocks per tile (CandidateBlocks), near the winners of the next
/// coarser level. Costs are still reduced from all candidates. The finest `window_levels` levels
/// (never the coarsest) are searched in windows instead.
///
/// `coarse_map` (Bayesian diffusion only) does not depend on whether finer levels are computed, nor
/// `check_map` on whether the map is. `volumes`: take the cells of their levels; costs of a level
/// are computed once more for them. `parts`: the only ones to compute, without volumes; null: all.
/// Levels, winners and outputs must then be those of the last call.
LevelCells match_coarse_to_fine(const MethodParameters& parameters,
                                const kernels::CandidateGeometry& geometry, const ChainInput& input,
                                const MapOutputs& outputs, CoarseLevels& levels,
                                Execution& execution,
                                const std::function<void(const MatchChain&)>& run,
                                const CoarseMap& coarse_map = {}, const CheckMap& check_map = {},
                                const std::vector<VolumeWriter>& volumes = {},
                                const SearchedParts* parts = nullptr);

}  // namespace vantage
